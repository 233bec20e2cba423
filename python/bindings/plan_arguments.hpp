#pragma once

#include <optional>
#include <string>

#include "bindings.hpp"
#include "mmgrasp/robot/trajectory.hpp"

namespace mmgrasp::python {

/// One pose (4, 4) or several (m, 4, 4).
Poses poses_argument(const ArrayLike& value, const std::string& name);

/// Waypoints (k, n), or None.
MaybeFloats path_array(const std::optional<JointPath>& path);
/// The same as lists, for to_dict().
py::object path_list(const std::optional<JointPath>& path);

void bind_cartesian_planning(py::module_& m);
void bind_timing(py::module_& m);
void bind_roadmap(py::module_& m);
void bind_manipulation_problem(py::module_& m);
void bind_manipulation_result(py::module_& m);

}  // namespace mmgrasp::python
