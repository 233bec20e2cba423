#pragma once

#include <pybind11/pybind11.h>

#include <string>

#include "arrays.hpp"
#include "long_call.hpp"
#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/core/error.hpp"
#include "options.hpp"
#include "shown.hpp"

namespace mmgrasp::python {

/// Makes the classes that others' signatures name, so that docstrings and stubs show Python names; members follow
/// later.
void declare_classes(py::module_& m);
/// A class made by declare_classes.
template <typename T>
py::class_<T> declared(py::module_& m, const char* name) {
  return py::reinterpret_borrow<py::class_<T>>(m.attr(name));
}

void bind_core(py::module_& m);
void bind_geometry(py::module_& m);
void bind_optim(py::module_& m);
void bind_robot(py::module_& m);
void bind_group(py::module_& m);
void bind_ik(py::module_& m);
void bind_ik_objectives(py::module_& m);
void bind_trajectory(py::module_& m);
void bind_collision(py::module_& m);
void bind_world(py::module_& m);
void bind_disabled_pairs(py::module_& m);
void bind_reach(py::module_& m);
void bind_grasp(py::module_& m);
void bind_hand(py::module_& m);
void bind_plan(py::module_& m);
void bind_base_regions(py::module_& m);
void bind_base_sequence(py::module_& m);
void bind_task(py::module_& m);
void bind_pickle(py::module_& m);  ///< After all classes.
void bind_platform_locations(py::module_& m);
void bind_verify(py::module_& m);

py::dict to_dict(const Rejections& rejections);

/// Throws InvalidInput unless the keywords are reach options in range.
void check_reach_options(const py::kwargs& options);

/// Path of a str or os.PathLike argument.
std::string path_argument(const py::handle& value, const std::string& name);

/// The group itself, or the same group on the robot with its collision pairs sampled when no SRDF gives any.
JointGroup with_sampled_pairs(const JointGroup& group);

}  // namespace mmgrasp::python
