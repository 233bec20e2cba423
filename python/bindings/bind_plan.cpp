#include "bindings.hpp"
#include "given.hpp"
#include "mmgrasp/plan/cartesian.hpp"
#include "mmgrasp/plan/motion.hpp"
#include "mmgrasp/plan/straight_line.hpp"
#include "mmgrasp/plan/time_parameterization.hpp"
#include "same_robot.hpp"

namespace mmgrasp::python {
namespace {

using namespace py::literals;

const std::vector<OptionField<MotionOptions>>& motion_fields() {
  using O = MotionOptions;
  static const std::vector<OptionField<O>> fields{
      option<O>("planner", &O::planner, "a name of planner_names()"),
      option<O>("time_limit", &O::time_limit, "wall-clock cap [s]"),
      option<O>("max_iterations", &O::max_iterations, "budget in states drawn"),
      option<O>("range", &O::range, "longest tree edge [rad]; 0: a share of the joint box's diagonal"),
      option<O>("base_margin", &O::base_margin, "the base is drawn this far around start and goals [m]"),
      option<O>("edge_step", &O::edge_step, "largest joint motion between two checks [rad or m]"),
      option<O>("workspace_step", &O::workspace_step, "largest motion of any robot point between two checks [m]"),
      option<O>("shorten", &O::shorten, "shortcut the path"),
      option<O>("shorten_iterations", &O::shorten_iterations, "tries of the shortening"),
      option<O>("ik_solutions", &O::ik_solutions, "IK solutions looked for at each tool pose"),
      option<O>("region_samples", &O::region_samples, "tool poses drawn in each region"),
      option<O>("seed", &O::seed, "same seed, same path")};
  return fields;
}

const std::vector<OptionField<TimingOptions>>& timing_fields() {
  using O = TimingOptions;
  static const std::vector<OptionField<O>> fields{
      option<O>("max_deviation", &O::max_deviation, "corners are blended within this joint distance [rad]"),
      option<O>("sample_period", &O::sample_period, "spacing of the samples [s]"),
      {"jerk_limits",
       [](O& o, const py::handle& v) {
         o.jerk_limits = v.is_none() ? Eigen::VectorXd() : vector_argument(v, "jerk_limits");
       },
       [](const O&) { return py::object(py::none()); }, "of each joint [rad/s^3]; None: no such limits"}};
  return fields;
}

const std::vector<OptionField<StraightLineOptions>>& line_fields() {
  using O = StraightLineOptions;
  static const std::vector<OptionField<O>> fields{
      option<O>("position_step", &O::position_step, "largest tool translation between two waypoints [m]"),
      option<O>("rotation_step", &O::rotation_step, "largest tool rotation between two waypoints [rad]"),
      option<O>("max_joint_step", &O::max_joint_step, "a larger joint motion between two waypoints is a jump"),
      option<O>("edge_step", &O::edge_step, "largest joint motion between two checks [rad or m]")};
  return fields;
}

py::object path_array(const std::optional<JointPath>& path) {
  if (!path) return py::none();
  return rows_to_array(path->waypoints);
}

/// One goal (n,) or several (m, n).
std::vector<Eigen::VectorXd> goals_argument(const ArrayLike& goal, Eigen::Index size) {
  const py::array array = py::array::ensure(goal);
  PyErr_Clear();
  if (array && array.ndim() == 2) return rows_argument(goal, "goal", size);
  return {vector_argument(goal, "goal", size)};
}

/// One pose (4, 4) or several (m, 4, 4).
Poses poses_argument(const ArrayLike& value, const std::string& name) {
  const py::array array = py::array::ensure(value);
  if (!array) PyErr_Clear();
  if (!array || array.ndim() != 3) return {pose_argument(value, name)};
  Poses poses;
  for (py::ssize_t i = 0; i < array.shape(0); ++i) {
    const std::string entry = name + "[" + std::to_string(i) + "]";
    poses.push_back(pose_argument(ArrayLike(py::object(array[py::int_(i)])), entry));
  }
  return poses;
}

MotionResult plan(const Given<Robot>& given_robot, const Given<JointGroup>& given_group, const Given<World>& world,
                  const ArrayLike& start, const py::object& goal, const py::object& tool_poses,
                  const Given<std::vector<ToolRegion>>& regions, const std::optional<Given<ToolCone>>& tool_cone,
                  const py::object& on_solution, const py::object& progress, const py::kwargs& options) {
  const JointGroup& group = taken(given_group, "group");
  check_same_robot(taken(given_robot, "robot"), group);
  MotionOptions read = read_options(motion_fields(), options, "plan_motion");
  if (tool_cone) read.tool_cone = taken(*tool_cone, "tool_cone");
  if (!on_solution.is_none()) {
    read.improved = [&](const JointPath& path, double cost) {
      const py::gil_scoped_acquire gil;
      on_solution(rows_to_array(path.waypoints), cost);
    };
  }
  const Eigen::VectorXd from = vector_argument(start, "start", group.size());
  MotionGoals goals;
  if (!goal.is_none()) goals.configurations = goals_argument(py::reinterpret_borrow<ArrayLike>(goal), group.size());
  if (!tool_poses.is_none())
    goals.tool_poses = poses_argument(py::reinterpret_borrow<ArrayLike>(tool_poses), "tool_poses");
  goals.regions = taken(regions, "regions", "ToolRegion");
  CollisionChecker checker(with_sampled_pairs(group), taken(world, "world"));
  return LongCall(progress).run(
      [&](const Monitor& monitor) { return plan_motion_to(checker, from, goals, read, monitor); });
}

void bind_goals(py::module_& m) {
  py::class_<ToolRegion>(m, "ToolRegion", "A box of tool poses around a pose.")
      .def(py::init([](const ArrayLike& pose, const py::object& position, const py::object& rotation) {
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
  py::class_<ToolCone>(m, "ToolCone", "Path constraint: an axis of the tool stays near an axis of the world.")
      .def(py::init([](const ArrayLike& tool_axis, const ArrayLike& world_axis, const Given<double>& half_angle) {
             ToolCone cone{vector3_argument(tool_axis, "tool_axis"), vector3_argument(world_axis, "world_axis"),
                           taken(half_angle, "half_angle")};
             cone.check();
             return cone;
           }),
           py::arg("tool_axis"), py::arg("world_axis"), py::arg("half_angle"),
           "tool_axis in the tip's frame; half_angle: the largest angle between the two [rad].")
      .def("__repr__", [](const ToolCone& c) {
        return "ToolCone(half_angle=" + std::string(py::repr(py::float_(c.half_angle))) + ")";
      });
}

void bind_motion(py::module_& m) {
  py::class_<MotionStats>(m, "MotionStats")
      .def_readonly("seconds", &MotionStats::seconds)
      .def_readonly("collision_queries", &MotionStats::collision_queries)
      .def_readonly("length_before_shortening", &MotionStats::length_before_shortening)
      .def("to_dict",
           [](const MotionStats& s) {
             return py::dict("seconds"_a = s.seconds, "collision_queries"_a = s.collision_queries,
                             "length_before_shortening"_a = s.length_before_shortening);
           })
      .def("__repr__", [](const MotionStats& s) {
        return "MotionStats(" + std::string(py::repr(py::float_(s.seconds))) + " s, " +
               std::to_string(s.collision_queries) + " queries)";
      });
  py::class_<MotionResult>(m, "MotionResult", "What plan_motion found.")
      .def_readonly("outcome", &MotionResult::outcome)
      .def_property_readonly(
          "path", [](const MotionResult& r) { return path_array(r.path); },
          "Waypoints (k, n), joined by straight lines; None unless solved.")
      .def_readonly("cost", &MotionResult::cost, "Length of the path in joint space.")
      .def_readonly("goal_index", &MotionResult::goal_index)
      .def_readonly("contacts", &MotionResult::contacts, "With invalid_start or invalid_goal: what touches.")
      .def_readonly("rejections", &MotionResult::rejections, "Of the start, or of goals, turned down.")
      .def_readonly("beyond_limits", &MotionResult::beyond_limits,
                    "With invalid_start or invalid_goal: which joint is outside of its limits, its value and these.")
      .def_readonly("stats", &MotionResult::stats)
      .def("to_dict",
           [](const MotionResult& r) {
             py::object path = path_array(r.path);
             if (!path.is_none()) path = path.attr("tolist")();
             py::list contacts;
             for (const Contact& c : r.contacts) contacts.append(py::cast(c).attr("to_dict")());
             return py::dict("outcome"_a = to_string(r.outcome), "path"_a = path, "cost"_a = r.cost,
                             "goal_index"_a = r.goal_index, "contacts"_a = contacts,
                             "rejections"_a = to_dict(r.rejections), "beyond_limits"_a = r.beyond_limits,
                             "stats"_a = py::cast(r.stats).attr("to_dict")());
           })
      .def("__repr__", [](const MotionResult& r) {
        std::string out = std::string("MotionResult(") + to_string(r.outcome);
        if (r.path) {
          out += ", " + std::to_string(r.path->waypoints.size()) + " waypoints, cost " +
                 std::string(py::repr(py::float_(r.cost)));
        }
        for (const Contact& c : r.contacts) out += ", '" + c.a + "' touches '" + c.b + "'";
        if (!r.beyond_limits.empty()) out += ", " + r.beyond_limits;
        return out + ")";
      });
  m.def("planner_names", &planner_names, "Names that plan_motion's `planner` takes.");
  m.def(
      "plan_motion", &plan, py::arg("robot"), py::arg("group"), py::arg("world"), py::kw_only(), py::arg("start"),
      py::arg("goal") = py::none(), py::arg("tool_poses") = py::none(), py::arg("regions") = std::vector<ToolRegion>{},
      py::arg("tool_cone") = py::none(), py::arg("on_solution") = py::none(), py::arg("progress") = py::none(),
      ("A collision-free path of the group from `start` (n,) to any of its goals: `goal` (n,) or several as (m, n),\n"
       "`tool_poses` of the tip, (4, 4) or (m, 4, 4), and `regions` of them, reached by inverse kinematics. "
       "`tool_cone`\n"
       "holds on the whole path. on_solution(path, cost) is called with each better path. A diff-drive base turns on\n"
       "the spot and drives straight." +
       option_help(motion_fields()))
          .c_str());
}

void bind_line(py::module_& m) {
  py::class_<StraightLineResult>(m, "StraightLineResult", "What plan_straight_line found.")
      .def_readonly("outcome", &StraightLineResult::outcome)
      .def_property_readonly(
          "path", [](const StraightLineResult& r) { return path_array(r.path); }, "(k, n) or None.")
      .def_readonly("fraction", &StraightLineResult::fraction, "How far along the line it came, in [0, 1].")
      .def_readonly("cause", &StraightLineResult::cause, "Why it ended there.")
      .def_readonly("contact", &StraightLineResult::contact, "What touches there, when something does, or None.")
      .def("to_dict",
           [](const StraightLineResult& r) {
             py::object path = path_array(r.path);
             if (!path.is_none()) path = path.attr("tolist")();
             return py::dict("outcome"_a = to_string(r.outcome), "path"_a = path, "fraction"_a = r.fraction,
                             "cause"_a = to_string(r.cause),
                             "contact"_a = r.contact ? py::cast(*r.contact).attr("to_dict")() : py::none());
           })
      .def("__repr__", [](const StraightLineResult& r) {
        return std::string("StraightLineResult(") + to_string(r.outcome) + ", fraction " +
               std::string(py::repr(py::float_(r.fraction))) +
               (r.contact ? ", '" + r.contact->a + "' touches '" + r.contact->b + "'" : "") + ")";
      });
  m.def(
      "plan_straight_line",
      [](CollisionChecker& checker, const ArrayLike& start, const ArrayLike& T_world_to, const py::kwargs& options) {
        const StraightLineOptions read = read_options(line_fields(), options, "plan_straight_line");
        return plan_straight_line(checker, vector_argument(start, "start", checker.group().size()),
                                  pose_argument(T_world_to, "T_world_to"), read);
      },
      py::arg("checker"), py::arg("start"), py::arg("T_world_to"),
      ("The tool moves on a straight line from the pose of `start` to T_world_to. A group that moves a diff_drive base "
       "is\nrefused: it could not follow such a path." +
       option_help(line_fields()))
          .c_str());
}

const std::vector<OptionField<CartesianOptions>>& cartesian_fields() {
  using O = CartesianOptions;
  using L = StraightLineOptions;
  static const std::vector<OptionField<O>> fields{
      option<O>("position_step", &O::line, &L::position_step, "largest tool translation between two waypoints [m]"),
      option<O>("rotation_step", &O::line, &L::rotation_step, "largest tool rotation between two waypoints [rad]"),
      option<O>("max_joint_step", &O::line, &L::max_joint_step, "a larger joint motion between waypoints is a jump"),
      option<O>("edge_step", &O::line, &L::edge_step, "largest joint motion between two checks [rad or m]"),
      option<O>("max_branches", &O::max_branches, "configurations of the first pose that are followed at most")};
  return fields;
}

void bind_cartesian(py::module_& m) {
  py::class_<CartesianResult>(m, "CartesianResult", "What plan_cartesian found.")
      .def_readonly("outcome", &CartesianResult::outcome)
      .def_property_readonly(
          "path", [](const CartesianResult& r) { return path_array(r.path); }, "(k, n) or None.")
      .def_readonly("corners", &CartesianResult::corners, "Waypoint at which each pose is reached.")
      .def_readonly("fraction", &CartesianResult::fraction, "How far the best branch came, in [0, 1].")
      .def_readonly("cause", &CartesianResult::cause, "Why it ended there.")
      .def_readonly("contact", &CartesianResult::contact, "What touches there, when something does, or None.")
      .def_readonly("branches", &CartesianResult::branches, "Allowed configurations of the first pose.")
      .def_readonly("tried", &CartesianResult::tried, "Of these: followed.")
      .def_readonly("rejections", &CartesianResult::rejections)
      .def("to_dict",
           [](const CartesianResult& r) {
             py::object path = path_array(r.path);
             if (!path.is_none()) path = path.attr("tolist")();
             return py::dict("outcome"_a = to_string(r.outcome), "path"_a = path, "corners"_a = r.corners,
                             "fraction"_a = r.fraction, "cause"_a = to_string(r.cause),
                             "contact"_a = r.contact ? py::cast(*r.contact).attr("to_dict")() : py::none(),
                             "branches"_a = r.branches, "tried"_a = r.tried, "rejections"_a = to_dict(r.rejections));
           })
      .def("__repr__", [](const CartesianResult& r) {
        return std::string("CartesianResult(") + to_string(r.outcome) + ", fraction " +
               std::string(py::repr(py::float_(r.fraction))) + ", " + std::to_string(r.tried) + " of " +
               std::to_string(r.branches) + " branches tried)";
      });
  m.def(
      "plan_cartesian",
      [](CollisionChecker& checker, const ArrayLike& tool_poses, const py::object& near, const py::object& progress,
         const py::kwargs& options) {
        const CartesianOptions read = read_options(cartesian_fields(), options, "plan_cartesian");
        const Poses poses = poses_argument(tool_poses, "tool_poses");
        std::optional<Eigen::VectorXd> from;
        if (!near.is_none()) {
          from = vector_argument(py::reinterpret_borrow<ArrayLike>(near), "near", checker.group().size());
        }
        return LongCall(progress).run(
            [&](const Monitor& monitor) { return plan_cartesian(checker, poses, from, read, monitor); });
      },
      py::arg("checker"), py::arg("tool_poses"), py::arg("near") = py::none(), py::kw_only(),
      py::arg("progress") = py::none(),
      ("The tip follows straight lines from pose to pose, from the inverse kinematics branch of the first pose that "
       "completes\nthem with the shortest way, counted from `near` (n,) when that is given. A group that moves a "
       "diff_drive base "
       "is\nrefused: it could not follow such a path." +
       option_help(cartesian_fields()))
          .c_str());
}

}  // namespace

void bind_plan(py::module_& m) {
  bind_goals(m);
  bind_motion(m);
  bind_cartesian(m);
  bind_line(m);
  m.def(
      "time_parameterize",
      [](const ArrayLike& path, const ArrayLike& velocity_limits, const ArrayLike& acceleration_limits,
         const std::vector<std::string>& names, const py::kwargs& options) {
        const TimingOptions read = read_options(timing_fields(), options, "time_parameterize");
        const JointPath waypoints{rows_argument(path, "path")};
        const Eigen::Index n = waypoints.waypoints.empty() ? -1 : waypoints.waypoints[0].size();
        const Eigen::VectorXd velocity = vector_argument(velocity_limits, "velocity_limits", n);
        const Eigen::VectorXd acceleration = vector_argument(acceleration_limits, "acceleration_limits", n);
        py::gil_scoped_release release;
        return time_parameterize(waypoints, velocity, acceleration, read, names);
      },
      py::arg("path"), py::arg("velocity_limits"), py::arg("acceleration_limits"), py::kw_only(),
      py::arg("names") = std::vector<std::string>{},
      ("Near time-optimal timing of waypoints (k, n), at rest at both ends; corners are blended, which may leave the "
       "path\n"
       "by max_deviation." +
       option_help(timing_fields()))
          .c_str());
  m.def(
      "time_parameterize_free",
      [](CollisionChecker& checker, const ArrayLike& path, double edge_step, const py::kwargs& options) {
        const TimingOptions read = read_options(timing_fields(), options, "time_parameterize_free");
        return time_parameterize_free(checker, JointPath{rows_argument(path, "path", checker.group().size())}, read,
                                      edge_step);
      },
      py::arg("checker"), py::arg("path"), py::kw_only(), py::arg("edge_step") = 0.01,
      "time_parameterize under the group's limits, the blended corners checked for collisions too.");
}

}  // namespace mmgrasp::python
