#include "bare_objects.hpp"

namespace mmgrasp::python {
namespace {

namespace py = pybind11;

thread_local int g_constructors = 0;  // cls(...) calls on this thread's stack
ternaryfunc g_call = nullptr;         // the metaclass's own
newfunc g_new = nullptr;              // that of all classes

/// The common base of all classes, and what derives from it alone: pybind11 would throw through C.
bool is_without_objects(PyTypeObject* type) {
  if (!py::detail::all_type_info(type).empty()) return false;
  PyErr_Format(PyExc_TypeError, "%.200s: has no objects of its own (pickles need protocol 2 or later)", type->tp_name);
  return true;
}

PyObject* call(PyObject* type, PyObject* args, PyObject* kwargs) {
  if (is_without_objects(reinterpret_cast<PyTypeObject*>(type))) return nullptr;
  ++g_constructors;
  PyObject* made = g_call(type, args, kwargs);
  --g_constructors;
  return made;
}

PyObject* new_object(PyTypeObject* type, PyObject* args, PyObject* kwargs) {
  if (is_without_objects(type)) return nullptr;
  if (g_constructors > 0) return g_new(type, args, kwargs);
  PyErr_Format(PyExc_TypeError, "%.200s: objects are made by %.200s(...), not by __new__", type->tp_name,
               type->tp_name);
  return nullptr;
}

void guard(PyTypeObject* type) {
  if (type->tp_new != g_new) return;
  type->tp_new = &new_object;
  PyType_Modified(type);
}

void guard_classes(const py::handle& scope) {
  for (const auto& item : py::dict(scope.attr("__dict__")))
    if (PyType_Check(item.second.ptr())) guard(reinterpret_cast<PyTypeObject*>(item.second.ptr()));
}

}  // namespace

void refuse_bare_objects(py::module_& m) {
  PyTypeObject* some = reinterpret_cast<PyTypeObject*>(m.attr("Robot").ptr());
  PyTypeObject* meta = Py_TYPE(m.attr("Robot").ptr());
  if (meta->tp_call == &call) return;  // in another interpreter of this process
  g_call = meta->tp_call;
  g_new = some->tp_new;
  meta->tp_call = &call;
  PyTypeObject* base = some;
  while (base->tp_base != &PyBaseObject_Type) base = base->tp_base;
  guard(base);
  guard_classes(m);
  guard_classes(m.attr("verify"));
}

}  // namespace mmgrasp::python
