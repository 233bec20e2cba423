#include <cmath>
#include <ctime>

#include "bindings.hpp"
#include "checker_argument.hpp"
#include "drive_by_arguments.hpp"
#include "long_call.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/optim/nlp_solver.hpp"
#include "mmgrasp/task/drive_by.hpp"
#include "push_fields.hpp"

namespace mmgrasp::python {
namespace {

constexpr char kEventRows[] = "list[mmgrasp.records.DriveByEventRow]";
using EventRows = Shown<kEventRows>;
constexpr char kPushKeywords[] = "dict[str, typing.Any]";
using PushKeywords = ShownDict<kPushKeywords>;
constexpr char kOptionalPush[] = "mmgrasp._core.PushGrasp | typing.Any";
using OptionalPush = Shown<kOptionalPush>;
constexpr char kOptionalTrajectory[] = "mmgrasp._core.WholeBodyTrajectory | typing.Any";
using OptionalTrajectory = Shown<kOptionalTrajectory>;

using namespace py::literals;

const std::vector<OptionField<DriveByOptions>>& drive_by_fields() {
  using O = DriveByOptions;
  using W = WholeBodyOptions;
  static const std::vector<OptionField<O>> fields{
      option<O>("waypoints", &O::waypoints, "waypoints of the whole motion"),
      option<O>("seeds", &O::seeds, "guesses tried until one leads to a solution"),
      option<O>("solutions", &O::solutions, "solutions compared for one grasp assignment"),
      option<O>("grasp_assignments", &O::grasp_assignments,
                "assignments of a candidate to each task that are planned; the fastest motion is returned; 1: only the "
                "one that "
                "looks quickest"),
      option<O>("goal_configurations", &O::goal_configurations, "configurations sought per candidate"),
      option<O>("iterations", &O::iterations,
                "iterations of all solves together; once they are spent no other solve begins"),
      option<O>("time_limit", &O::time_limit, "wall-clock cap [s]"),
      option<O>("jerk_time", &O::jerk_time, "accelerations may go from 0 to their limit in no less [s]; 0: no limit"),
      option<O>("collisions", &O::collisions, "the robot keeps clear of the world and of itself"),
      option<O>("seed", &O::seed, "same seed, same answer"),
      option<O>("threads", &O::threads, "0: all; does not change the answer"),
      option<O>("solver", &O::trajectory, &W::solver, "a name of nlp_solver_names()"),
      option<O>("tolerance", &O::trajectory, &W::tolerance, "relative optimality"),
      option<O>("max_iterations", &O::trajectory, &W::max_iterations,
                "iterations of one solve; an optimisation takes at most 1 + refinements solves"),
      option<O>("solve_time_limit", &O::trajectory, &W::time_limit,
                "wall-clock cap of one optimisation, which has 1 + refinements solves at most [s]"),
      option<O>("smoothing", &O::trajectory, &W::smoothing,
                "weight of the mean square of accelerations over their limits [s]"),
      option<O>("margin", &O::trajectory, &W::margin, "distance to keep from obstacles and from oneself [m]"),
      option<O>("constraint_distance", &O::trajectory, &W::constraint_distance,
                "pairs of bodies nearer than this are constrained [m]"),
      option<O>("refinements", &O::trajectory, &W::refinements, "times that collision constraints may be added")};
  return fields;
}

py::dict violation_dict(const Violation& v) {
  return py::dict("value"_a = v.value, "tolerance"_a = v.tolerance, "unit"_a = v.unit, "time"_a = v.time,
                  "waypoint"_a = v.waypoint, "what"_a = v.what, "kept"_a = v.kept());
}

py::dict event_dict(const DriveByEvent& e) {
  return py::dict(
      "waypoint"_a = e.waypoint, "time"_a = e.time, "close_time"_a = e.close_time, "object"_a = e.object,
      "attach_time"_a = e.attach_time,
      "T_tip_object"_a = e.object.empty() ? py::none() : py::object(to_array(e.T_tip_object).attr("tolist")()),
      "candidate"_a = e.candidate, "base_speed"_a = e.base_speed, "tool_speed"_a = e.tool_speed,
      "push"_a = e.push ? py::object(outcome_dict(*e.push)) : py::object(py::none()));
}

Poses candidates_argument(const ArrayLike& value) {
  const py::array array = plain_array(value, "T_world_tip");
  Poses poses;
  if (array && array.ndim() == 3) {
    for (py::ssize_t i = 0; i < array.shape(0); ++i)
      poses.push_back(pose_argument(ArrayLike(py::object(array[py::int_(i)])), "T_world_tip"));
    if (poses.empty()) throw InvalidInput("T_world_tip = []: must hold at least one pose");
    return poses;
  }
  return {pose_argument(value, "T_world_tip")};
}

std::vector<bool> axes_argument(const std::vector<std::string>& names) {
  const std::vector<std::string> known{"x", "y", "z", "roll", "pitch", "yaw"};
  std::vector<bool> free(6, false);
  for (const std::string& name : names) {
    bool found = false;
    for (std::size_t i = 0; i < 6; ++i) {
      if (name != known[i]) continue;
      free[i] = true;
      found = true;
    }
    if (!found) throw InvalidInput("free_axes = '" + name + "': must be of x, y, z, roll, pitch, yaw");
  }
  return free;
}

/// Keywords of push_grasp, and approach, free_length, covariance and closing_direction.
DriveByPush push_argument(const py::dict& given) {
  DriveByPush push;
  py::dict closing;
  for (const auto& [key, value] : given) {
    const std::string name = py::cast<std::string>(key);
    if (name == "approach") {
      push.approach = vector_argument(py::reinterpret_borrow<py::object>(value), "approach", 3);
    } else if (name == "closing_direction") {
      push.closing_direction = vector_argument(py::reinterpret_borrow<py::object>(value), "closing_direction", 3);
    } else if (name == "covariance") {
      const Eigen::MatrixXd rows = matrix_argument(value, name, 3);
      if (rows.rows() != 3) throw InvalidInput("covariance: must be (3, 3)");
      push.covariance = rows;
    } else if (name == "free_length") {
      convert(value, name, push.free_length);
    } else {
      closing[key] = value;
    }
  }
  push.closing = read_options(push_fields(), py::kwargs(closing), "push");
  return push;
}

void bind_drive_by_task(py::module_& m) {
  py::class_<DriveByTask>(
      m, "DriveByTask",
      "Something the tool does on the way: T_world_tip, (4, 4), or candidates (m, 4, 4) of which any will do.\n\n"
      "    task = mg.DriveByTask(mg.pose([2.0, -0.8, 0.75]), dwell=0.5, free_axes=[\"yaw\"])\n\n"
      "tolerance: (6,) along x, y, z [m] and about them [rad] of the pose's own frame; free_axes: names of axes along "
      "or\nabout which any error is allowed, of x, y, z, roll, pitch, yaw; max_tool_speed [m/s] at the task; dwell [s] "
      "for which\nthe tool's pose is kept, e.g. while a gripper closes; object: name of the world's object that is "
      "attached afterwards:\nan obstacle for the whole robot, the open hand included, until then; the fingers alone "
      "may "
      "touch it during the dwell.\nWhat rests on something counts as 1 mm higher once it is attached.\n\n"
      "push: a gripper that closes while the hand moves on (P1 4.3): dict of push_grasp's keywords, approach (3,), an "
      "axis of\nthe tip's frame, free_length [m], the straight way before the finger tips reach the object, covariance "
      "(3, 3) [m^2]\nof the object's position in the world, of which `sigmas` standard deviations are covered, and "
      "closing_direction (3,)\nof the fingers in the tip's frame. "
      "T_world_tip is then\nthe planned grasp; tolerance, free_axes, max_tool_speed and dwell are left out.")
      .def(py::init([](const ArrayLike& T_world_tip, const OptionalArray& tolerance,
                       const std::vector<std::string>& free_axes, const OptionalNumber& max_tool_speed, double dwell,
                       const std::string& object, const std::optional<PushKeywords>& push,
                       const NoMoreKeywords& unknown) {
             refuse_unknown("DriveByTask", unknown,
                            {"T_world_tip", "tolerance", "free_axes", "max_tool_speed", "dwell", "object", "push"});
             DriveByTask task;
             task.candidates = candidates_argument(T_world_tip);
             if (!tolerance.is_none()) task.tolerance = vector_argument(tolerance, "tolerance", 6);
             for (int i = 0; i < 6; ++i) {
               if (task.tolerance[i] < 0) throw InvalidInput("tolerance: entries must be at least 0");
             }
             task.free_axes = axes_argument(free_axes);
             if (!max_tool_speed.is_none()) {
               task.max_tool_speed = finite_argument(py::cast<double>(max_tool_speed), "max_tool_speed");
             }
             if (!(task.max_tool_speed > 0)) throw InvalidInput("max_tool_speed: must be positive");
             task.dwell = finite_argument(dwell, "dwell");
             if (task.dwell < 0) throw InvalidInput("dwell: must be at least 0");
             task.object = object;
             if (push) task.push = push_argument(*push);
             return task;
           }),
           py::arg("T_world_tip"), py::kw_only(), py::arg("tolerance") = py::none(),
           py::arg("free_axes") = std::vector<std::string>{}, py::arg("max_tool_speed") = py::none(),
           py::arg("dwell") = 0.0, py::arg("object") = "", py::arg("push") = py::none(),
           "The class says what the arguments mean; raises InvalidInput naming one that breaks its rule.")
      .def_property_readonly(
          "candidates", [](const DriveByTask& t) { return to_array(t.candidates); }, "(m, 4, 4)")
      .def_readonly("max_tool_speed", &DriveByTask::max_tool_speed,
                    "Fastest tool at the task [m/s]; infinite: no limit.")
      .def_readonly("dwell", &DriveByTask::dwell, "Time for which the tool's pose is kept [s].")
      .def_readonly("object", &DriveByTask::object,
                    "Name of the world's object that is attached afterwards; empty: none.")
      .def_property_readonly(
          "push",
          [](const DriveByTask& t) -> OptionalPush {
            return t.push ? py::cast(push_grasp(push_closing(t))) : py::object(py::none());
          },
          "What push_grasp says: closing time, window, tolerance to the object's position; None without one.")
      .def("__repr__", [](const DriveByTask& t) {
        return "DriveByTask(" + std::to_string(t.candidates.size()) +
               (t.candidates.size() == 1 ? " pose" : " candidates") + ")";
      });
}

void bind_trajectory_class(py::module_& m) {
  using T = WholeBodyTrajectory;
  py::class_<T, std::shared_ptr<T>>(m, "WholeBodyTrajectory",
                                    "Base and arm on one clock. Between waypoints the drive velocities are linear in "
                                    "time; for a diff-drive base they are\n"
                                    "its speed v and turning rate omega, so that it never slips sideways.")
      .def_property_readonly(
          "names", [](const T& t) { return t.group().names(); }, "One a column of `positions`: x, y, theta first.")
      .def_property_readonly(
          "drive_names", [](const T& t) { return drive_names(t.group()); },
          "Columns of `drive`: v [m/s] and omega [rad/s] of a diff-drive base, x, y, theta of an omni base; then the "
          "joints.")
      .def_property_readonly(
          "times", [](const T& t) { return py::array_t<double>(py::ssize_t(t.size()), t.times().data()); },
          "(k,) [s], of the waypoints")
      .def_property_readonly(
          "positions", [](const T& t) { return rows_to_array(t.positions()); }, "(k, n)")
      .def_property_readonly(
          "drive", [](const T& t) { return rows_to_array(t.drive()); }, "(k, d), columns as drive_names")
      .def_property_readonly("duration", &T::duration, "[s]")
      .def(
          "at", [](const T& t, double time) { return t.at(finite_argument(time, "time")); }, py::arg("time"),
          "Configuration (n,) at a time [s], clamped at the ends.")
      .def(
          "drive_at", [](const T& t, double time) { return t.drive_at(finite_argument(time, "time")); },
          py::arg("time"), "Drive velocities (d,) at a time [s].")
      .def(
          "rolled_out", [](const T& t, int steps) { return rows_to_array(t.rolled_out(steps)); }, py::arg("steps") = 64,
          "(k, n): where the robot is at the waypoints when only the drive velocities are followed from the first one.")
      .def(
          "sampled", [](const T& t, int between) { return interruptible([&] { return t.sampled(between); }); },
          py::arg("between") = 0,
          "A JointTrajectory of all waypoints and of `between` samples after each; x, y, theta first, with their "
          "velocities.")
      .def(
          "to_csv", [](const T& t, int between) { return interruptible([&] { return t.to_csv(between); }); },
          py::arg("between") = 0,
          "Header time, names, name.velocity, name.acceleration, base.v, base.vy, base.omega, wheel.left, "
          "wheel.right.")
      .def("__len__", &T::size)
      .def("__repr__", [](const T& t) {
        return "WholeBodyTrajectory(" + std::to_string(t.size()) + " waypoints, " +
               std::string(py::repr(py::float_(t.duration()))) + " s)";
      });
}

void bind_drive_by_result(py::module_& m) {
  py::class_<DriveByResult>(m, "DriveByResult", "What plan_drive_by found.")
      .def_readonly("outcome", &DriveByResult::outcome,
                    "`solved`: every constraint is kept on a finer roll-out; `approximate`: the best iterate, with its "
                    "violations.")
      .def_property_readonly(
          "trajectory",
          [](const DriveByResult& r) -> OptionalTrajectory {
            return py::cast(std::const_pointer_cast<WholeBodyTrajectory>(r.trajectory));
          },
          "The answer or, when not solved, the best iterate; None when there was not even a guess.")
      .def_property_readonly("duration", &DriveByResult::duration, "[s]")
      .def_property_readonly(
          "events",
          [](const DriveByResult& r) -> EventRows {
            py::list events;
            for (const DriveByEvent& e : r.events) events.append(event_dict(e));
            return events;
          },
          "One dict per task: waypoint, time and close_time [s], object (what is held then), attach_time [s] and "
          "T_tip_object, "
          "candidate, base_speed and\ntool_speed [m/s].")
      .def_property_readonly(
          "violations", [](const DriveByResult& r) { return violations_dict(r.violations); },
          "Each kind of constraint: value (0 when kept), tolerance, unit, time [s], waypoint, what, kept; measured on "
          "a "
          "roll-out ten times\nfiner than the waypoints.")
      .def_readonly("grasp_assignments", &DriveByResult::grasp_assignments, "Choices of candidates planned.")
      .def_readonly("solves", &DriveByResult::solves, "Guesses from which the optimiser began.")
      .def_readonly("iterations", &DriveByResult::iterations, "Iterations of the optimiser, over all solves.")
      .def_readonly("seconds", &DriveByResult::seconds, "Wall-clock time of the call [s].")
      .def_readonly("report", &DriveByResult::report, "What was tried, and what is broken where, by how much.")
      .def(
          "to_csv",
          [](const DriveByResult& r, int between) { return interruptible([&] { return drive_by_csv(r, between); }); },
          py::arg("between") = 0,
          "The trajectory's to_csv with two columns more: task, its index in the row of a task's waypoint, and "
          "attached, "
          "the "
          "object in the hand.")
      .def(
          "to_dict",
          [](const DriveByResult& r) {
            py::object trajectory = py::none();
            if (r.trajectory) {
              trajectory =
                  py::dict("names"_a = r.trajectory->group().names(),
                           "drive_names"_a = drive_names(r.trajectory->group()), "times"_a = r.trajectory->times(),
                           "positions"_a = rows_to_array(r.trajectory->positions()).attr("tolist")(),
                           "drive"_a = rows_to_array(r.trajectory->drive()).attr("tolist")());
            }
            py::list events;
            for (const DriveByEvent& e : r.events) events.append(event_dict(e));
            return py::dict("outcome"_a = to_string(r.outcome), "duration"_a = r.duration(),
                            "trajectory"_a = trajectory, "events"_a = events,
                            "violations"_a = violations_dict(r.violations), "grasp_assignments"_a = r.grasp_assignments,
                            "solves"_a = r.solves, "iterations"_a = r.iterations, "seconds"_a = r.seconds,
                            "report"_a = r.report);
          },
          "As a dict of plain numbers, strings and lists, e.g. for JSON.")
      .def("__repr__", [](const DriveByResult& r) {
        return std::string("DriveByResult(") + to_string(r.outcome) +
               (r.trajectory ? ", " + std::string(py::repr(py::float_(r.duration()))) + " s" : "") + ", " +
               std::to_string(r.solves) + " solves)";
      });
}

DriveByResult shorten(const JointGroup& group, const World& world, const std::vector<DriveByTask>& tasks,
                      std::vector<double> times, const ArrayLike& positions, std::vector<double> task_times,
                      const Progress& progress, const py::kwargs& options) {
  const DriveByOptions read = read_options(drive_by_fields(), options, "shorten_drive_by");
  const KnownMotion known{std::move(times), rows_argument(positions, "positions", group.size()), std::move(task_times)};
  const JointGroup with_pairs = with_sampled_pairs(group);
  return LongCall(progress).run(
      [&](const Monitor& monitor) { return shorten_drive_by(with_pairs, world, tasks, known, read, monitor); });
}

DriveByResult drive_by(const RobotOrChecker& robot, const OptionalGroup& given_group, const OptionalWorld& world,
                       const ArrayLike& start, const std::vector<DriveByTask>& tasks, const ArrayLike& goal,
                       const Progress& progress, const py::kwargs& options) {
  const CollisionChecker checker = checker_argument(robot, given_group, world);
  const JointGroup& group = checker.group();
  const DriveByOptions read = read_options(drive_by_fields(), options, "plan_drive_by");
  const Eigen::VectorXd from = vector_argument(start, "start", group.size());
  const DriveByGoal to = goal_argument(goal, group.size());
  return LongCall(progress).run(
      [&](const Monitor& monitor) { return plan_drive_by(checker, from, tasks, to, read, monitor); });
}

}  // namespace

ViolationRows violations_dict(const std::vector<Violation>& violations) {
  py::dict result;
  for (const Violation& v : violations) result[v.kind.c_str()] = violation_dict(v);
  return result;
}

DriveByGoal goal_argument(const ArrayLike& goal, Eigen::Index size) {
  const py::array array = plain_array(goal, "goal");
  if (array && array.ndim() == 2) {
    const Eigen::MatrixXd box = matrix_argument(goal, "goal", size, detail::kInfinity);
    if (box.rows() != 2) throw InvalidInput("goal: must be (n,), or (2, n) with lower and upper bounds");
    return {box.row(0).transpose(), box.row(1).transpose()};
  }
  const Eigen::VectorXd q = vector_argument(goal, "goal", size);
  return {q, q};
}

void bind_trajopt(py::module_& m) {
  m.def("nlp_solver_names", &nlp_solver_names, "Names that plan_drive_by's `solver` takes.");
  m.def("_drive_by_option_table", [] { return option_table(drive_by_fields()); });
  bind_drive_by_task(m);
  m.def(
      "_first_drive_by_guess",
      [](const JointGroup& group, const ArrayLike& start, const std::vector<DriveByTask>& tasks, const ArrayLike& goal,
         int waypoints) -> py::object {
        DriveByOptions options;
        options.waypoints = waypoints;
        const Eigen::VectorXd from = vector_argument(start, "start", group.size());
        const auto first = first_drive_by_guess(group, from, tasks, goal_argument(goal, group.size()), options);
        if (!first) return py::none();
        std::vector<int> intervals;
        for (const WholeBodySegment& s : first->problem.segments) intervals.push_back(s.intervals);
        const auto solve = [first = *first] {
          const WholeBodyResult r = optimize_whole_body(first.problem, first.guess);
          const std::clock_t begun = std::clock();
          check_whole_body(first.problem, *r.trajectory);
          const double judging = static_cast<double>(std::clock() - begun) / CLOCKS_PER_SEC;
          return py::make_tuple(r.outcome == Outcome::solved, r.trajectory->duration(), judging, r.iterations);
        };
        return py::dict("positions"_a = rows_to_array(first->guess.positions), "steps"_a = first->guess.steps,
                        "intervals"_a = intervals, "goal"_a = first->problem.goal_lower,
                        "solve"_a = py::cpp_function(solve));
      },
      py::arg("group"), py::kw_only(), py::arg("start"), py::arg("tasks"), py::arg("goal"), py::arg("waypoints") = 35,
      "The guess of the first seed, for benchmarks against other optimisers; None when a task is out of reach. "
      "solve() "
      "takes it from there, judging included: whether it is solved, the duration, processor seconds that judging once "
      "more "
      "took, and iterations.");
  bind_trajectory_class(m);
  bind_drive_by_result(m);
  m.def(
      "plan_drive_by", &drive_by, py::arg("robot"), py::arg("group") = py::none(), py::arg("world") = py::none(),
      py::kw_only(), py::arg("start"), py::arg("tasks"), py::arg("goal"), py::arg("progress") = py::none(),
      ("The fastest motion of base and arm from `start` (n,), at rest, through the tasks in order to `goal`, at "
       "rest, without\n"
       "stopping for them (P1 chapter 4). goal: a configuration (n,), or (2, n) with lower and upper bounds, "
       "infinite where it\n"
       "does not matter. The world's objects and the robot itself are obstacles. A prepared CollisionChecker may stand "
       "in place of robot, group and world." +
       option_help(drive_by_fields()))
          .c_str());
  m.def(
      "shorten_drive_by", &shorten, py::arg("group"), py::arg("world"), py::kw_only(), py::arg("tasks"),
      py::arg("times"), py::arg("positions"), py::arg("task_times"), py::arg("progress") = py::none(),
      ("plan_drive_by from a motion that is known instead of guesses: positions (m, n) at times [s], straight between "
       "them, free of\ncollisions, from rest to rest, at each task at its time; e.g. a drive and a pick one after the "
       "other. The answer is near that\nmotion. Tasks have one pose and no push." +
       option_help(drive_by_fields()))
          .c_str());
}

}  // namespace mmgrasp::python
