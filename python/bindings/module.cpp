#include "bare_objects.hpp"
#include "bindings.hpp"
#include "long_call.hpp"
#include "mmgrasp/collision/world.hpp"
#include "mmgrasp/robot/joint_group.hpp"

namespace mmgrasp::python {

void bind_distance_fields(py::module_& m);
void bind_mapping(py::module_& m);
void bind_sdf(py::module_& m);
void bind_world_maps(py::module_& m);
void bind_segmentation(py::module_& m);
void bind_graspability(py::module_& m);
void bind_synthesis(py::module_& m);
void bind_capability(py::module_& m);
void bind_trajopt(py::module_& m);
void bind_robot_motion(py::module_& m);
void bind_control(py::module_& m);
void bind_structure(py::module_& m);
void bind_beam_frame(py::module_& m);
void bind_object_path(py::module_& m);
void bind_gripper_design(py::module_& m);
void bind_push_grasp(py::module_& m);
void bind_manipulation(py::module_& m);

void declare_classes(py::module_& m) {
  py::class_<Robot>(m, "Robot", "A robot as URDF and SRDF describe it. Immutable; joints and links by name.");
  py::class_<JointGroup>(m, "JointGroup", "Joints that are planned together, and a tip. Immutable.");
  py::class_<World>(m, "World",
                    "Named rigid bodies around the robot, and what it holds. Poses are T_world_object, (4, 4).");
}

}  // namespace mmgrasp::python

PYBIND11_MODULE(_core, m) {
  using namespace mmgrasp::python;
  m.doc() = "The C++ library behind mmgrasp. Import names from mmgrasp itself.";
  m.attr("__version__") = MMGRASP_VERSION;
  declare_classes(m);
  bind_core(m);
  bind_geometry(m);
  bind_distance_fields(m);
  bind_optim(m);
  bind_robot(m);
  bind_collision(m);
  bind_ik_objectives(m);
  bind_reach(m);
  bind_capability(m);
  bind_grasp(m);
  bind_plan(m);
  bind_manipulation(m);
  bind_control(m);
  bind_push_grasp(m);
  bind_task(m);
  bind_trajopt(m);
  bind_robot_motion(m);
  bind_pickle(m);
  bind_platform_locations(m);
  bind_mapping(m);
  bind_sdf(m);
  bind_world_maps(m);
  bind_segmentation(m);
  bind_graspability(m);
  bind_synthesis(m);
  bind_structure(m);
  bind_beam_frame(m);
  bind_object_path(m);
  bind_gripper_design(m);
  bind_verify(m);
  refuse_bare_objects(m);
  end_calls_at_exit();
}
