#include <optional>

#include "bindings.hpp"
#include "given.hpp"
#include "mmgrasp/plan/manipulation.hpp"
#include "plan_arguments.hpp"

namespace mmgrasp::python {
namespace {

constexpr char kShapeOrShapes[] = "mmgrasp._core.LinkShape | collections.abc.Sequence[mmgrasp._core.LinkShape]";
using ShapeOrShapes = Shown<kShapeOrShapes>;
constexpr char kGraspsOrPoses[] = "collections.abc.Sequence[mmgrasp._core.Grasp] | numpy.typing.ArrayLike";
using GraspsOrPoses = Shown<kGraspsOrPoses>;

using namespace py::literals;

/// A list of Grasp, or poses as (m, 4, 4).
std::vector<Grasp> grasps_argument(const py::object& value) {
  if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value)) {
    const auto items = py::reinterpret_borrow<py::sequence>(value);
    std::vector<Grasp> out;
    bool all = true;
    for (const py::handle& item : items) {
      all = all && py::isinstance<Grasp>(item);
      if (all) out.push_back(py::cast<Grasp>(item));
    }
    if (all) return out;
  }
  const py::array array = plain_array(value, "grasps");
  if (!array) refuse_value("grasps", value, "a list of Grasp or an array (m, 4, 4)");
  if (array.ndim() != 3 || array.shape(1) != 4 || array.shape(2) != 4) {
    throw InvalidInput("grasps has shape " + std::string(py::str(array.attr("shape"))) +
                       ": must be a list of Grasp or an array (m, 4, 4)");
  }
  std::vector<Grasp> out;
  for (py::ssize_t i = 0; i < array.shape(0); ++i) {
    const py::object pose = array[py::int_(i)];
    out.emplace_back().T_object_hand = pose_argument(pose, "grasps[" + std::to_string(i) + "]");
  }
  return out;
}

std::vector<LinkShape> object_argument(const py::object& value) {
  if (py::isinstance<LinkShape>(value)) return {py::cast<LinkShape>(value)};
  try {
    return py::cast<std::vector<LinkShape>>(value);
  } catch (const py::cast_error&) {
    refuse_value("object", value, "a LinkShape or a list of them");
  }
}

using Strings = std::vector<std::string>;

}  // namespace

void bind_manipulation_problem(py::module_& m) {
  py::class_<ManipulationProblem>(
      m, "ManipulationProblem",
      "Moves an object from one pose to another with any of many grasps (P2 4.2): the planner chooses the grasp.\n"
      "\n"
      "    problem = mg.ManipulationProblem(arm, world, shapes, T_world_start, T_world_goal, grasps)\n"
      "    result = mg.plan_manipulation(problem, time_limit=5.0)\n"
      "    if result.outcome == mg.Outcome.solved:\n"
      "        print(result.grasp_index, len(result.path))")
      .def(py::init([](const Given<JointGroup>& group, const Given<World>& world, const ShapeOrShapes& object,
                       const ArrayLike& T_world_start, const ArrayLike& T_world_goal, const GraspsOrPoses& grasps,
                       const std::optional<Given<Hand>>& gripper, const Given<Strings>& touch_links,
                       const Given<std::string>& object_name, const NoMoreKeywords& unknown) {
             refuse_unknown("ManipulationProblem", unknown,
                            {"group", "world", "object", "T_world_start", "T_world_goal", "grasps", "gripper",
                             "touch_links", "object_name"});
             ManipulationProblem problem{with_sampled_pairs(taken(group, "group")),
                                         taken(world, "world"),
                                         object_argument(object),
                                         pose_argument(T_world_start, "T_world_start"),
                                         pose_argument(T_world_goal, "T_world_goal"),
                                         grasps_argument(grasps)};
             if (gripper) problem.gripper = taken(*gripper, "gripper");
             const Strings links = taken(touch_links, "touch_links", "names of links");
             problem.touch_links = {links.begin(), links.end()};
             problem.object_name = taken(object_name, "object_name");
             problem.check();
             return problem;
           }),
           "group"_a, "world"_a, "object"_a, "T_world_start"_a, "T_world_goal"_a, "grasps"_a, py::kw_only(),
           "gripper"_a = py::none(), "touch_links"_a = Strings{}, "object_name"_a = "object",
           "`object` is a LinkShape or a list of them, in its own frame; `world` is without it. `grasps` are "
           "Grasp, or poses of the hand in the object's frame as (m, 4, 4). With `gripper` the fingers are "
           "set to each grasp's opening. Links in `touch_links` may touch the object; none given: those of the end "
           "effector. The group may be an arm or an arm on an omni base; a diff_drive base is refused, since it could "
           "not drive the paths.")
      .def_property_readonly(
          "T_world_start", [](const ManipulationProblem& p) { return to_array(p.T_world_start); },
          "Pose of the object at the beginning (4, 4).")
      .def_property_readonly(
          "T_world_goal", [](const ManipulationProblem& p) { return to_array(p.T_world_goal); },
          "Pose of the object at the end (4, 4).")
      .def_readonly("group", &ManipulationProblem::group, "Arm, or arm and omni base; its tip is the tool.")
      .def_readonly("world", &ManipulationProblem::world, "The world without the object.")
      .def_readonly("object", &ManipulationProblem::object, "Shapes of the object in its own frame.")
      .def_readonly("grasps", &ManipulationProblem::grasps, "The grasps to choose from.")
      .def_readonly("object_name", &ManipulationProblem::object_name, "Name under which it is attached.")
      .def("__repr__", [](const ManipulationProblem& p) {
        return "ManipulationProblem('" + p.object_name + "', " + std::to_string(p.grasps.size()) + " grasps, '" +
               p.group.name() + "')";
      });
}

}  // namespace mmgrasp::python
