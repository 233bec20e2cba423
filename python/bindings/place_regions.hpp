#pragma once

#include <pybind11/stl.h>

#include "bindings.hpp"

namespace mmgrasp::python {

/// Where picked parts go: the bin on the robot, or a rectangle at the goal.
void bind_place_regions(py::module_& m);

}  // namespace mmgrasp::python
