#pragma once

#include <pybind11/pybind11.h>

namespace mmgrasp::python {

/// Objects of this module's classes come from their constructors: cls.__new__(cls) alone, whose object would hold
/// memory that nothing was written to, raises TypeError. Classes that pickle need it and keep it.
void refuse_bare_objects(pybind11::module_& m);

}  // namespace mmgrasp::python
