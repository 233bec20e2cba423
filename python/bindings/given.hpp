#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <string>
#include <vector>

#include "options.hpp"

namespace mmgrasp::python {

namespace py = pybind11;

/// An argument meant to be a T and taken as it comes, while signatures go on showing T: taken() turns it into one with
/// the argument's name in the message, where pybind11's own conversion would only say "incompatible arguments".
template <typename T>
class Given : public py::object {
  PYBIND11_OBJECT_DEFAULT(Given, py::object, [](PyObject* o) { return static_cast<int>(o != nullptr); })
};

template <typename T>
std::string class_name() {
  return py::cast<std::string>(py::type::of<T>().attr("__name__"));
}

/// The instance of a bound class itself; lives as long as the argument.
template <typename T>
const T& taken(const Given<T>& value, const char* name) {
  if (!py::isinstance<T>(value)) refuse_value(name, value, ("a " + class_name<T>()).c_str());
  return py::cast<const T&>(value);
}

template <typename T>
std::vector<T> taken(const Given<std::vector<T>>& value, const char* name, const char* of_what) {
  try {
    return py::cast<std::vector<T>>(value);
  } catch (const py::cast_error&) {
    refuse_value(name, value, (std::string("a list of ") + of_what).c_str());
  }
}

/// Finite.
inline double taken(const Given<double>& value, const char* name) {
  double out = 0;
  convert(value, name, out);
  return out;
}

inline int taken(const Given<int>& value, const char* name) {
  int out = 0;
  convert(value, name, out);
  return out;
}

inline std::string taken(const Given<std::string>& value, const char* name) {
  std::string out;
  convert(value, name, out);
  return out;
}

}  // namespace mmgrasp::python

namespace pybind11::detail {
template <typename T>
struct handle_type_name<mmgrasp::python::Given<T>> {
  static constexpr auto name = make_caster<T>::name;
};
}  // namespace pybind11::detail
