#pragma once

#include <string>

#include "bindings.hpp"
#include "packed_classes.hpp"

namespace mmgrasp::python {

/// How objects of one class go into a pickle and come out of it.
struct PickleFunctions {
  py::object (*pack)(const py::handle& self);
  py::object (*make)(const py::handle& state);
};

/// Objects of the class `name` pickle by these, and are copied through them.
void set_pickle(const py::module_& m, const char* name, PickleFunctions functions);

/// Pickles of a plain struct, member by member.
template <typename T>
void plain(const py::module_& m, const char* name) {
  set_pickle(m, name,
             {[](const py::handle& self) { return Packed<T>::from(py::cast<const T&>(self)); },
              [](const py::handle& state) { return py::object(py::cast(Packed<T>::to(state))); }});
}

void bind_plain_pickles(py::module_& m);
void bind_task_pickles(py::module_& m);

}  // namespace mmgrasp::python
