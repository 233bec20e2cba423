#include "bindings.hpp"
#include "checker_argument.hpp"
#include "given.hpp"
#include "joint_weights.hpp"
#include "mmgrasp/plan/motion.hpp"
#include "plan_arguments.hpp"
#include "solution_callback.hpp"

namespace mmgrasp::python {
namespace {

using namespace py::literals;

const std::vector<OptionField<MotionOptions>>& motion_fields() {
  using O = MotionOptions;
  static const std::vector<OptionField<O>> fields{
      option<O>("planner", &O::planner, "a name of planner_names()"),
      option<O>("time_limit", &O::time_limit, "wall-clock cap [s]"),
      option<O>("max_iterations", &O::max_iterations, "budget in states drawn"),
      joint_weights_option<O>(&O::joint_weights),
      option<O>("range", &O::range,
                "longest tree edge [rad or m, times the weights' root mean square]; 0: a share of the joint limits' "
                "diagonal"),
      option<O>("near_end_probability", &O::near_end_probability,
                "roadmap planners: chance to draw around the start or a goal; 0: uniform draws alone"),
      option<O>("base_margin", &O::base_margin, "the base is drawn this far around start and goals [m]"),
      option<O>("joint_step", &O::joint_step, "largest joint motion between two checks [rad or m]"),
      option<O>("workspace_step", &O::workspace_step, "largest motion of any robot point between two checks [m]"),
      option<O>("shorten", &O::shorten, "shortcut the path"),
      option<O>("shorten_iterations", &O::shorten_iterations, "tries of the shortening"),
      option<O>("ik_solutions", &O::ik_solutions,
                "arm postures looked for at each tool pose, each in all its whole turns"),
      option<O>("region_samples", &O::region_samples, "tool poses drawn in each region"),
      option<O>("seed", &O::seed, "same seed, same path")};
  return fields;
}

/// One goal (n,) or several (m, n).
std::vector<Eigen::VectorXd> goals_argument(const ArrayLike& goal, Eigen::Index size) {
  const py::array array = plain_array(goal, "goal");
  if (array && array.ndim() == 2) return rows_argument(goal, "goal", size);
  return {vector_argument(goal, "goal", size)};
}

MotionResult motion(const RobotOrChecker& robot, const OptionalGroup& given_group, const OptionalWorld& world,
                    const ArrayLike& start, const OptionalArray& goal, const OptionalArray& tool_poses,
                    const Given<std::vector<ToolRegion>>& regions, const OptionalArray& via,
                    const std::optional<Given<OrientationConstraint>>& orientation_constraint,
                    const OptionalPadding& padding, const OnSolution& on_solution, const Progress& progress,
                    const py::kwargs& options) {
  CollisionChecker checker = checker_argument(robot, given_group, world, padding);
  const JointGroup group = checker.group();
  MotionOptions read = read_options(motion_fields(), options, "plan_motion");
  if (orientation_constraint) read.orientation_constraint = taken(*orientation_constraint, "orientation_constraint");
  SolutionCallback callback(on_solution);
  const Eigen::VectorXd from = vector_argument(start, "start", group.size());
  MotionGoals goals;
  if (!goal.is_none()) goals.configurations = goals_argument(py::reinterpret_borrow<ArrayLike>(goal), group.size());
  if (!tool_poses.is_none())
    goals.tool_poses = poses_argument(py::reinterpret_borrow<ArrayLike>(tool_poses), "tool_poses");
  goals.regions = taken(regions, "regions", "ToolRegion");
  if (goal.is_none() && tool_poses.is_none() && goals.regions.empty())
    throw InvalidInput("goal = None: give goal, tool_poses or regions");
  std::vector<Eigen::VectorXd> waypoints;
  if (!via.is_none()) waypoints = rows_argument(py::reinterpret_borrow<ArrayLike>(via), "via", group.size());
  return callback.run(progress, [&](const Monitor& monitor, const ImprovementCallback& better) {
    read.on_improvement = better;
    return plan_motion_via(checker, from, waypoints, goals, read, monitor);
  });
}

void bind_goals(py::module_& m) {
  py::class_<ToolRegion>(m, "ToolRegion", "A box of tool poses around a pose.")
      .def(py::init([](const ArrayLike& pose, const OptionalArray& position, const OptionalArray& rotation) {
             ToolRegion region;
             region.T_world_region = pose_argument(pose, "pose");
             if (!position.is_none()) region.position = vector3_argument(position, "position");
             if (!rotation.is_none()) region.rotation = vector3_argument(rotation, "rotation");
             region.check("ToolRegion");
             return region;
           }),
           py::arg("pose"), py::arg("position") = py::none(), py::arg("rotation") = py::none(),
           "pose (4, 4) times a translation within +-position [m] times a rotation rpy within +-rotation [rad].")
      .def("__repr__", [](const ToolRegion& r) {
        return "ToolRegion(position=" + std::string(py::repr(py::cast(r.position))) +
               ", rotation=" + std::string(py::repr(py::cast(r.rotation))) + ")";
      });
  py::class_<OrientationConstraint>(m, "OrientationConstraint",
                                    "Path constraint: an axis of the tool stays near an axis of the world.")
      .def(py::init([](const ArrayLike& tool_axis, const ArrayLike& world_axis, const Given<double>& half_angle) {
             OrientationConstraint cone{vector3_argument(tool_axis, "tool_axis"),
                                        vector3_argument(world_axis, "world_axis"), taken(half_angle, "half_angle")};
             cone.check();
             return cone;
           }),
           py::arg("tool_axis"), py::arg("world_axis"), py::arg("half_angle"),
           "tool_axis in the tip's frame; half_angle: the largest angle between the two [rad].")
      .def("__repr__", [](const OrientationConstraint& c) {
        return "OrientationConstraint(half_angle=" + std::string(py::repr(py::float_(c.half_angle))) + ")";
      });
}

void bind_motion(py::module_& m) {
  py::class_<MotionStats>(m, "MotionStats", "What a search of plan_motion took.")
      .def_readonly("seconds", &MotionStats::seconds, "Wall-clock time [s].")
      .def_readonly("collision_queries", &MotionStats::collision_queries, "Configurations checked.")
      .def_readonly("length_before_shortening", &MotionStats::length_before_shortening,
                    "Length of the first path in joint space, weighted likewise.")
      .def(
          "to_dict",
          [](const MotionStats& s) {
            return py::dict("seconds"_a = s.seconds, "collision_queries"_a = s.collision_queries,
                            "length_before_shortening"_a = s.length_before_shortening);
          },
          "As a dict of plain numbers, strings and lists, e.g. for JSON.")
      .def("__repr__", [](const MotionStats& s) {
        return "MotionStats(" + std::string(py::repr(py::float_(s.seconds))) + " s, " +
               std::to_string(s.collision_queries) + " queries)";
      });
  py::class_<MotionResult>(m, "MotionResult", "What plan_motion found.")
      .def_readonly("outcome", &MotionResult::outcome, "How it ended; `solved` alone comes with an answer.")
      .def_property_readonly(
          "path", [](const MotionResult& r) { return path_array(r.path); },
          "Waypoints (k, n), joined by straight lines; None unless solved.")
      .def_readonly("cost", &MotionResult::cost, "Length of the path in joint space, weighted by `joint_weights`.")
      .def_readonly("goal_index", &MotionResult::goal_index, "Which of the goals the path reaches; -1 unless solved.")
      .def_readonly("contacts", &MotionResult::contacts, "With invalid_start or invalid_goal: what touches.")
      .def_readonly("rejections", &MotionResult::rejections, "Why the start, or goals, were rejected.")
      .def_readonly("beyond_limits", &MotionResult::beyond_limits,
                    "With invalid_start or invalid_goal: which joint is outside of its limits, its value and these.")
      .def_readonly("via_reached", &MotionResult::via_reached,
                    "With `via`: how many of them a path was found to; all when solved.")
      .def_readonly("stats", &MotionResult::stats, "What the search took.")
      .def(
          "to_dict",
          [](const MotionResult& r) {
            py::list contacts;
            for (const Contact& c : r.contacts) contacts.append(py::cast(c).attr("to_dict")());
            return py::dict("outcome"_a = to_string(r.outcome), "path"_a = path_list(r.path), "cost"_a = r.cost,
                            "goal_index"_a = r.goal_index, "contacts"_a = contacts,
                            "rejections"_a = to_dict(r.rejections), "beyond_limits"_a = r.beyond_limits,
                            "via_reached"_a = r.via_reached, "stats"_a = py::cast(r.stats).attr("to_dict")());
          },
          "As a dict of plain numbers, strings and lists, e.g. for JSON.")
      .def("__repr__", [](const MotionResult& r) {
        std::string out = std::string("MotionResult(") + to_string(r.outcome);
        if (r.path) {
          out += ", " + std::to_string(r.path->waypoints.size()) + " waypoints, cost " +
                 std::string(py::repr(py::float_(r.cost)));
        }
        if (!r.path && r.rejections.total() > 0) out += ", rejected: " + r.rejections.summary();
        for (const Contact& c : r.contacts) out += ", " + describe(c);
        if (!r.beyond_limits.empty()) out += ", " + r.beyond_limits;
        return out + ")";
      });
  m.def("_motion_option_table", [] { return option_table(motion_fields()); });
  m.def("planner_names", &planner_names, "Names that plan_motion's `planner` takes.");
  m.def(
      "plan_motion", &motion, py::arg("robot"), py::arg("group") = py::none(), py::arg("world") = py::none(),
      py::kw_only(), py::arg("start"), py::arg("goal") = py::none(), py::arg("tool_poses") = py::none(),
      py::arg("regions") = std::vector<ToolRegion>{}, py::arg("via") = py::none(),
      py::arg("orientation_constraint") = py::none(), py::arg("padding") = py::none(),
      py::arg("on_solution") = py::none(), py::arg("progress") = py::none(),
      ("A collision-free path of the group from `start` (n,) to any of its goals: `goal` (n,) or several as (m, n),\n"
       "`tool_poses` of the tip, (4, 4) or (m, 4, 4), and `regions` of them, reached by inverse kinematics; by way of "
       "the\nconfigurations `via` (k, n), one after the other. A prepared CollisionChecker may stand in place of "
       "robot, group\nand world. `orientation_constraint` holds on the whole path. `padding`: in place of the world's "
       "own, see\nWorld.padding. `on_solution` is called with every better path (an Improvement); what it raises ends "
       "the call.\nA diff-drive base turns on the spot and drives straight." +
       option_help(motion_fields()))
          .c_str());
}

}  // namespace

void bind_plan(py::module_& m) {
  bind_goals(m);
  bind_motion(m);
  bind_cartesian_planning(m);
  bind_timing(m);
}

}  // namespace mmgrasp::python
