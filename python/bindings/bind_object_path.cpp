// Carrying an object along given poses with one grasp: what it costs and how the arm moves.
#include <optional>

#include "bindings.hpp"
#include "given.hpp"
#include "mmgrasp/structure/object_path.hpp"
#include "plan_arguments.hpp"

namespace mmgrasp::python {
namespace {

using namespace py::literals;
using Strings = std::vector<std::string>;

const std::vector<OptionField<ObjectPathOptions>>& object_path_fields() {
  using O = ObjectPathOptions;
  static const std::vector<OptionField<O>> fields{
      option<O>("motion_weight", &O::motion_weight, "weight of O1, the joints' motion"),
      option<O>("deflection_weight", &O::deflection_weight, "weight of O2, the largest displacements"),
      option<O>("manipulability_weight", &O::manipulability_weight, "weight of O3, the force manipulability"),
      option<O>("motion_scale", &O::motion_scale, "O1 is divided by it [rad or m]"),
      option<O>("deflection_scale", &O::deflection_scale, "O2 is divided by it [m]"),
      option<O>("manipulability_scale", &O::manipulability_scale, "O3 is divided by it"),
      option<O>("max_joint_step", &O::max_joint_step, "more from pose to pose is a jump, refused [rad or m]"),
      option<O>("position_tolerance", &O::position_tolerance, "of the object half way between poses [m]"),
      option<O>("rotation_tolerance", &O::rotation_tolerance, "of the object half way between poses [rad]"),
      option<O>("edge_step", &O::edge_step, "largest joint step between collision checks [rad or m]"),
      option<O>("check_edges", &O::check_edges, "check motions between poses for collisions"),
      option<O>("single_configuration", &O::single_configuration, "one arm configuration a pose (P2's single IK)"),
      option<O>("all_turns", &O::all_turns, "joints that may turn more than once come in every turn"),
      option<O>("redundant_values", &O::redundant_values, "samples of a seventh joint; 0: chosen"),
      option<O>("gravity", &O::gravity, "along the world's -z [m/s2]")};
  return fields;
}

ObjectPathProblem make_problem(const Given<JointGroup>& group, const Given<World>& world,
                               const Given<std::vector<LinkShape>>& object, const ArrayLike& T_world_object,
                               const std::optional<Given<Hand>>& gripper, const Given<Strings>& touch_links,
                               const std::optional<Given<BeamFrame>>& frame, const Given<std::string>& object_name) {
  ObjectPathProblem problem{with_sampled_pairs(taken(group, "group")),
                            taken(world, "world"),
                            taken(object, "object", "LinkShape"),
                            poses_argument(T_world_object, "T_world_object"),
                            {},
                            {},
                            {},
                            taken(object_name, "object_name")};
  if (gripper) problem.gripper = taken(*gripper, "gripper");
  if (frame) problem.frame = taken(*frame, "frame");
  const Strings links = taken(touch_links, "touch_links", "names of links");
  problem.touch_links = {links.begin(), links.end()};
  problem.check();
  return problem;
}

py::dict result_dict(const ObjectPathResult& r) {
  return py::dict("outcome"_a = to_string(r.outcome), "cost"_a = r.cost, "joint_motion"_a = r.joint_motion,
                  "deflection"_a = r.deflection, "force_manipulability"_a = r.force_manipulability,
                  "path"_a = path_list(r.outcome == Outcome::solved ? std::optional(r.path) : std::nullopt),
                  "sag"_a = r.sag, "violation"_a = r.violation, "violations"_a = r.violations,
                  "rejections"_a = to_dict(r.rejections), "refused_edges"_a = r.refused_edges,
                  "configurations"_a = r.configurations);
}

std::string result_text(const ObjectPathResult& r) {
  if (r.outcome == Outcome::solved) {
    return "ObjectPathResult(solved, cost " + std::string(py::repr(py::float_(r.cost))) + ", " +
           std::to_string(r.path.waypoints.size()) + " waypoints)";
  }
  int unreachable = 0, collide = 0, first = -1;
  for (std::size_t i = 0; i < r.violations.size(); ++i) {
    unreachable += r.violations[i] == 2;
    collide += r.violations[i] == 1;
    if (r.violations[i] && first < 0) first = static_cast<int>(i);
  }
  std::string out = "ObjectPathResult(not_found, violation " + std::to_string(r.violation);
  if (first < 0) return out + ": every pose is reached, but no motion joins them)";
  return out + ": " + std::to_string(unreachable) + " poses out of reach, " + std::to_string(collide) +
         " in collision, the first is " + std::to_string(first) + ")";
}

void bind_result(py::module_& m) {
  using R = ObjectPathResult;
  py::class_<R>(m, "ObjectPathResult", "What one grasp costs along a path of the object, and the arm's motion.")
      .def_readonly("outcome", &R::outcome, "solved or not_found.")
      .def_readonly("cost", &R::cost, "Weighted sum of the objectives over their scales; 0 unless solved.")
      .def_readonly("joint_motion", &R::joint_motion, "O1: sum of joint-space distances [rad or m].")
      .def_readonly("deflection", &R::deflection, "O2: sum of the largest displacements after the first pose [m].")
      .def_readonly("force_manipulability", &R::force_manipulability, "O3: its sum along the tool's motion.")
      .def_property_readonly(
          "path",
          [](const R& r) { return path_array(r.outcome == Outcome::solved ? std::optional(r.path) : std::nullopt); },
          "(poses, n) configurations, or None.")
      .def_readonly("sag", &R::sag, "Largest displacement at each pose [m].")
      .def_readonly("violation", &R::violation, "P2's Cost(C); 0 if and only if solved.")
      .def_readonly("violations", &R::violations, "Of each pose: 2 out of reach, 1 in collision, 0 neither.")
      .def_property_readonly(
          "rejections", [](const R& r) { return to_dict(r.rejections); }, "Configurations rejected, by cause.")
      .def_readonly("refused_edges", &R::refused_edges, "Motions between poses that collide or leave the path.")
      .def_readonly("configurations", &R::configurations, "Arm configurations found over all poses.")
      .def("to_dict", &result_dict, "Everything as plain values.")
      .def("__repr__", &result_text);
}

}  // namespace

void bind_object_path(py::module_& m) {
  m.def("_object_path_option_table", [] { return option_table(object_path_fields()); });
  bind_result(m);
  using P = ObjectPathProblem;
  py::class_<P>(m, "ObjectPathProblem", "A robot that carries an object along given poses (P2 3.2.1).")
      .def(py::init(&make_problem), "group"_a, "world"_a, "object"_a, "T_world_object"_a, py::kw_only(),
           "gripper"_a = py::none(), "touch_links"_a = Strings{}, "frame"_a = py::none(), "object_name"_a = "object",
           "`object`: LinkShapes in its own frame; `world` is without it. `T_world_object` (m, 4, 4): where it lies,\n"
           "then where it goes. With `gripper` the fingers open as the grasp says; `frame`: how the object bends.")
      .def_readonly("group", &P::group, "Its tip is the tool frame of grasps.")
      .def_readonly("world", &P::world, "Without the object.")
      .def_property_readonly(
          "T_world_object", [](const P& p) { return to_array(p.T_world_object); }, "(m, 4, 4)")
      .def("__repr__", [](const P& p) {
        return "ObjectPathProblem('" + p.object_name + "', " + std::to_string(p.T_world_object.size()) + " poses, '" +
               p.group.name() + "')";
      });
  using E = ObjectPathEvaluator;
  py::class_<E>(m, "ObjectPathEvaluator",
                "Costs many grasps along one path: prepared once. Not for several threads at a time.")
      .def(py::init([](const Given<P>& problem, const py::kwargs& options) {
             return E(taken(problem, "problem"), read_options(object_path_fields(), options, "ObjectPathEvaluator"));
           }),
           "problem"_a, ("Prepares robot, world and object." + option_help(object_path_fields())).c_str())
      .def(
          "evaluate",
          [](E& evaluator, const Given<Grasp>& given) {
            const Grasp grasp = taken(given, "grasp");
            return evaluator.evaluate(grasp);
          },
          "grasp"_a, "The least cost over all arm configurations, or how far the grasp is from allowed.");
  m.def(
      "follow_object_path",
      [](const Given<P>& given_problem, const Given<Grasp>& given_grasp, const py::kwargs& options) {
        const P problem = taken(given_problem, "problem");
        const Grasp grasp = taken(given_grasp, "grasp");
        const ObjectPathOptions read = read_options(object_path_fields(), options, "follow_object_path");
        py::gil_scoped_release release;
        return follow_object_path(problem, grasp, read);
      },
      "problem"_a, "grasp"_a,
      ("The cheapest motion of the arm that carries the object through all poses with one grasp, over all arm\n"
       "configurations (P2 3.3.3, Algorithm 3.1), motions between poses checked finely." +
       option_help(object_path_fields()))
          .c_str());
}

}  // namespace mmgrasp::python
