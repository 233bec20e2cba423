#include "bare_objects.hpp"
#include "bindings.hpp"
#include "long_call.hpp"
#include "mmgrasp/collision/world.hpp"
#include "mmgrasp/robot/joint_group.hpp"
#include "thread_stacks.hpp"
#include "unfit_arguments.hpp"

namespace mmgrasp::python {

void bind_distance_fields(py::module_& m);
void bind_mapping(py::module_& m);
void bind_sdf(py::module_& m);
void bind_world_maps(py::module_& m);
void bind_segmentation(py::module_& m);
void bind_segment_mesh(py::module_& m);
void bind_graspability(py::module_& m);
void bind_synthesis(py::module_& m);
void bind_capability(py::module_& m);
void bind_trajopt(py::module_& m);
void bind_nonlinear(py::module_& m);
void bind_robot_motion(py::module_& m);
void bind_control(py::module_& m);
void bind_structure(py::module_& m);
void bind_beam_frame(py::module_& m);
void bind_object_path(py::module_& m);
void bind_assembly(py::module_& m);
void bind_gripper_design(py::module_& m);
void bind_grasp_holding(py::module_& m);
void bind_operation_checks(py::module_& m);
void bind_plan_grippers(py::module_& m);
void bind_push_grasp(py::module_& m);
void bind_manipulation(py::module_& m);

void declare_classes(py::module_& m) {
  py::class_<Robot>(m, "Robot",
                    "A robot as URDF and SRDF describe it: links, joints, collision shapes, groups, pairs that need no "
                    "collision check.\n"
                    "Immutable; joints and links by name.\n"
                    "\n"
                    "    robot = mg.Robot.load(\"robot.urdf\", \"robot.srdf\", base=\"diff_drive\")\n"
                    "    arm = robot.group(\"arm\", tip=\"gripper_tcp\")\n"
                    "    robot.links, arm.names");
  py::class_<JointGroup>(
      m, "JointGroup",
      "Joints that are planned together, and a tip: where configurations, limits and kinematics are. Immutable.\n"
      "\n"
      "    q = arm.q({\"elbow_joint\": 1.2})\n"
      "    T_world_tip = arm.fk(q)\n"
      "    found = arm.ik(T_world_tip, seed=q)\n"
      "    if found.outcome == mg.Outcome.solved:\n"
      "        print(found.q, found.position_error)\n"
      "\n"
      "Configurations are arrays (n,): base joints x, y, theta first when the group has them (`with_base=True`), then "
      "the chain in\n"
      "order. All other joints stay at the group's reference values.");
  py::class_<World>(
      m, "World",
      "What stands around the robot and what it holds: named rigid bodies, and who may touch whom. Poses are\n"
      "T_world_object, (4, 4).\n"
      "\n"
      "    world = mg.World()\n"
      "    world.add_box(\"table\", size=(1.2, 0.6, 0.04), pose=mg.pose([1.0, 0, 0.7]))\n"
      "    world.add(\"cup\", mg.Cylinder(0.04, 0.1), mg.pose([1.0, 0, 0.775]))\n"
      "    world.allow(\"cup\", \"table\")\n"
      "    world.attach(\"cup\", \"gripper_link\", mg.pose([0.1, 0, 0]))  # from now on it moves with the link\n"
      "\n"
      "A checker or planner keeps the world that it was given: later changes do not reach it.");
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
  bind_nonlinear(m);
  bind_robot_motion(m);
  bind_platform_locations(m);
  bind_mapping(m);
  bind_sdf(m);
  bind_world_maps(m);
  bind_segmentation(m);
  bind_segment_mesh(m);
  bind_graspability(m);
  bind_synthesis(m);
  bind_structure(m);
  bind_beam_frame(m);
  bind_object_path(m);
  bind_assembly(m);
  bind_gripper_design(m);
  bind_grasp_holding(m);
  bind_operation_checks(m);
  bind_plan_grippers(m);
  bind_verify(m);
  bind_pickle(m);
  refuse_bare_objects(m);
  explain_argument_errors(m);
  end_calls_at_exit();
  give_threads_room();
}
