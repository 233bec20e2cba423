#include "unfit_arguments.hpp"

#include <string_view>

namespace mmgrasp::python {
namespace {

namespace py = pybind11;

using Dispatcher = PyObject* (*)(PyObject*, PyObject* const*, std::size_t, PyObject*);
Dispatcher g_dispatch = nullptr;  // pybind11's: what all its functions call

PyObject* g_invalid_input = nullptr;

/// pybind11's own message, or what becomes of its cast_error (bind_core.cpp).
bool is_unfit(const py::str& message) {
  const auto text = py::cast<std::string>(message);
  return text.find(" arguments. The following argument types are supported:") < 200 ||  // behind the function's name
         text.rfind("an argument of ", 0) == 0;
}

/// Puts the short message in place of the other, which stays where something goes wrong.
void shorten_message(PyObject* const* args, std::size_t flagged, PyObject* names) {
  py::error_scope raised;
  try {
    const py::str message(py::handle(raised.value));
    if (!is_unfit(message)) return;
    const std::size_t count = PyVectorcall_NARGS(flagged);
    py::tuple given(count);
    for (std::size_t i = 0; i < count; ++i) given[i] = py::handle(args[i]);
    py::dict named;
    for (py::ssize_t i = 0; names && i < PyTuple_GET_SIZE(names); ++i)
      named[py::handle(PyTuple_GET_ITEM(names, i))] = py::handle(args[count + i]);
    py::object text = py::module_::import("mmgrasp._argument_errors").attr("explain")(message, given, named);
    Py_XDECREF(raised.value);
    raised.value = text.release().ptr();
  } catch (py::error_already_set& error) {
    if (error.matches(PyExc_Exception)) return;
    Py_XDECREF(raised.type), Py_XDECREF(raised.value), Py_XDECREF(raised.trace);  // Ctrl-C goes before
    error.restore();
    PyErr_Fetch(&raised.type, &raised.value, &raised.trace);
  } catch (const py::cast_error&) {  // a message that is no UTF-8
  }
}

PyObject* explained_call(PyObject* self, PyObject* const* args, std::size_t flagged, PyObject* names) {
  PyObject* result = g_dispatch(self, args, flagged, names);
  if (!result && (PyErr_ExceptionMatches(PyExc_TypeError) || PyErr_ExceptionMatches(g_invalid_input)))
    shorten_message(args, flagged, names);
  return result;
}

PyMethodDef* method_of(py::handle function) {
  if (function && PyInstanceMethod_Check(function.ptr())) function = PyInstanceMethod_GET_FUNCTION(function.ptr());
  if (!function || !PyCFunction_Check(function.ptr())) return nullptr;
  return reinterpret_cast<PyCFunctionObject*>(function.ptr())->m_ml;
}

void explain_function(py::handle function) {
  PyMethodDef* method = method_of(function);
  const auto ours = reinterpret_cast<PyCFunction>(reinterpret_cast<void (*)()>(g_dispatch));
  if (method && method->ml_meth == ours)
    method->ml_meth = reinterpret_cast<PyCFunction>(reinterpret_cast<void (*)()>(&explained_call));
}

void explain_functions(py::handle scope) {
  for (const auto& item : py::dict(scope.attr("__dict__"))) {
    const py::handle value = item.second;
    if (PyType_Check(value.ptr())) {
      if (std::string_view(Py_TYPE(value.ptr())->tp_name) == "pybind11_type") explain_functions(value);
    } else if (PyObject_TypeCheck(value.ptr(), &PyProperty_Type)) {
      explain_function(value.attr("fget"));
      explain_function(value.attr("fset"));
    } else if (PyObject_TypeCheck(value.ptr(), &PyStaticMethod_Type)) {
      explain_function(value.attr("__func__"));
    } else {
      explain_function(value);
    }
  }
}

}  // namespace

void explain_argument_errors(py::module_& m) {
  g_invalid_input = m.attr("InvalidInput").ptr();  // bind_core.cpp keeps it
  PyMethodDef* some = method_of(m.attr("pose"));
  g_dispatch = reinterpret_cast<Dispatcher>(reinterpret_cast<void (*)()>(some->ml_meth));
  explain_functions(m);
  explain_functions(m.attr("verify"));
}

}  // namespace mmgrasp::python
