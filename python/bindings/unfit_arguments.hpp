#pragma once

#include <pybind11/pybind11.h>

namespace mmgrasp::python {

/// From now on calls whose arguments fit none of their signatures say which argument is wrong, in one line
/// (mmgrasp/_argument_errors.py), where pybind11 lists all signatures and prints all arguments.
void explain_argument_errors(pybind11::module_& m);

}  // namespace mmgrasp::python
