#include <cmath>

#include "bindings.hpp"
#include "long_call.hpp"
#include "mmgrasp/task/base_route.hpp"
#include "mmgrasp/task/drive_by.hpp"
#include "motion_message.hpp"

namespace mmgrasp::python {
namespace {

using namespace py::literals;

constexpr char kGripperRows[] = "list[mmgrasp.records.GripperEventRow]";
using GripperRows = Shown<kGripperRows>;

py::object plain(const Eigen::VectorXd& values) {
  return py::cast(values).attr("tolist")();
}

py::dict clock(double time) {
  std::int64_t nanoseconds = std::llround(time * 1e9);
  return py::dict("sec"_a = nanoseconds / 1'000'000'000, "nanosec"_a = nanoseconds % 1'000'000'000);
}

py::list gripper_rows(const RobotMotion& motion) {
  py::list rows;
  for (const GripperEvent& e : motion.gripper) {
    rows.append(py::dict("time"_a = e.time, "duration"_a = e.duration, "command"_a = e.closes ? "close" : "open",
                         "opening"_a = std::isnan(e.opening) ? py::object(py::none()) : py::cast(e.opening),
                         "object"_a = e.object));
  }
  return rows;
}

void command(RobotMotion& motion, const std::string& what, const OptionalNumber& opening, double duration,
             const std::string& object) {
  GripperEvent event;
  if (what != "open" && what != "close") throw InvalidInput("command = '" + what + "': must be open or close");
  if (!opening.is_none()) {
    event.opening = finite_argument(py::cast<double>(opening), "opening");
    if (event.opening < 0) throw InvalidInput("opening: must be at least 0");
  }
  event.time = motion.duration();
  event.duration = finite_argument(duration, "duration");
  event.closes = what == "close";
  event.object = object;
  motion.wait(event.duration);
  motion.gripper.push_back(event);
}

RobotMotion drive(const BasePath& path, const Robot& robot, const JointGroup& arm, const ArrayLike& configuration,
                  double period) {
  if (arm.has_base()) throw InvalidInput("arm: must be a group without the base");
  const Eigen::VectorXd q = vector_argument(configuration, "configuration", arm.size());
  return interruptible(
      [&] { return base_path_motion(path, robot.base(), robot.base_limits(), arm.names(), q, period); });
}

/// The same along poses as plan.json has them, for a robot of which only the names of the arm's joints are needed.
RobotMotion drive_along(const ArrayLike& poses, const Robot& robot, const std::vector<std::string>& joints,
                        const ArrayLike& configuration, double period) {
  BasePath path;
  path.outcome = Outcome::solved;
  for (const Eigen::VectorXd& row : rows_argument(poses, "poses", 3)) path.poses.emplace_back(row);
  const Eigen::VectorXd q = vector_argument(configuration, "configuration", static_cast<Eigen::Index>(joints.size()));
  return interruptible([&] { return base_path_motion(path, robot.base(), robot.base_limits(), joints, q, period); });
}

RobotMotion drive_by(const DriveByResult& result, const std::vector<double>& openings, double period) {
  return interruptible([&] { return drive_by_motion(result, openings, period); });
}

}  // namespace

std::optional<Eigen::Vector3d> base_pose_argument(const OptionalArray& base_pose) {
  if (base_pose.is_none()) return {};
  return vector3_argument(base_pose, "base_pose");
}

MotionMessage motion_message(const RobotMotion& motion) {
  py::list points;
  for (std::size_t i = 0; i < motion.times.size(); ++i) {
    points.append(py::dict("positions"_a = plain(motion.positions[i]), "velocities"_a = plain(motion.velocities[i]),
                           "accelerations"_a = plain(motion.accelerations[i]), "effort"_a = py::list(),
                           "time_from_start"_a = clock(motion.times[i]), "base_pose"_a = plain(motion.base_poses[i]),
                           "base_twist"_a = plain(motion.base_twists[i])));
  }
  return py::dict("header"_a = py::dict("frame_id"_a = "world"), "joint_names"_a = motion.joints, "points"_a = points,
                  "gripper"_a = gripper_rows(motion));
}

void bind_robot_motion(py::module_& m) {
  using M = RobotMotion;
  py::class_<M>(m, "RobotMotion",
                "What a robot carries out: arm, base and gripper on one clock. Made of a trajectory, a drive "
                "(`of_drive`) or a motion in\n"
                "passing (`of_drive_by`); `append` joins them. Between points the base's twist is linear in time, the "
                "arm a cubic.")
      .def(py::init([](const JointTrajectory& trajectory, const OptionalArray& base_pose) {
             return robot_motion(trajectory, base_pose_argument(base_pose));
           }),
           py::arg("trajectory"), py::arg("base_pose") = py::none(),
           "The motion of a timed trajectory. Columns x, y, theta, where it begins with them, are the base's; "
           "otherwise the base "
           "stands at\n"
           "base_pose (x, y, theta), the origin by default.")
      .def_static(
          "of_drive", &drive, py::arg("path"), py::arg("robot"), py::arg("arm"), py::arg("configuration"),
          py::kw_only(), py::arg("period") = 0.1,
          "The motion of a drive of the robot's base within its limits, `path.duration(robot)` long, with the arm at a "
          "configuration (n,);\n"
          "points at most `period` [s] apart.")
      .def_static("of_drive_by", &drive_by, py::arg("result"), py::kw_only(),
                  py::arg("openings") = std::vector<double>{}, py::arg("period") = 0.02,
                  "The motion that plan_drive_by found: points at most `period` [s] apart, and the gripper closing at "
                  "every task "
                  "that takes\n"
                  "an object, to these openings [m], in order; none given: not known.")
      .def("append", &M::append, py::arg("next"),
           "Goes on with `next`, whose clock begins where this ends. Raises InvalidInput unless base and joints begin "
           "where they are.")
      .def("wait", &M::wait, py::arg("duration"), "Base and arm stand still for so long [s].")
      .def("command_gripper", &command, py::arg("command"), py::kw_only(), py::arg("opening") = py::none(),
           py::arg("duration") = 0.0, py::arg("object") = "",
           "At the end, standing still: `open` or `close` to an opening [m], which takes `duration` [s]; object: what "
           "is taken or\n"
           "left.")
      .def_readonly("joints", &M::joints, "Joints of the arm, one a column.")
      .def_property_readonly(
          "times", [](const M& t) { return py::array_t<double>(py::ssize_t(t.times.size()), t.times.data()); },
          "(k,) [s], from 0")
      .def_property_readonly(
          "positions", [](const M& t) { return rows_to_array(t.positions); }, "(k, n) [rad or m]")
      .def_property_readonly(
          "velocities", [](const M& t) { return rows_to_array(t.velocities); }, "(k, n) [rad/s or m/s]")
      .def_property_readonly(
          "accelerations", [](const M& t) { return rows_to_array(t.accelerations); }, "(k, n) [rad/s^2 or m/s^2]")
      .def_property_readonly(
          "base_poses", [](const M& t) { return rows_to_array(t.base_poses); },
          "(k, 3): x, y [m], theta [rad] in the world; theta is not wrapped.")
      .def_property_readonly(
          "base_twists", [](const M& t) { return rows_to_array(t.base_twists); },
          "(k, 3): v_x, v_y [m/s], omega [rad/s] in the platform's own frame.")
      .def_property_readonly(
          "gripper", [](const M& t) -> GripperRows { return gripper_rows(t); },
          "What the gripper does, in order: time and duration [s], command (open or close), opening [m] or None, "
          "object.")
      .def_property_readonly("duration", &M::duration, "[s]")
      .def(
          "to_csv", [](const M& t) { return interruptible([&] { return t.to_csv(); }); },
          "Header time, base.x, base.y, base.theta, base.v, base.vy, base.omega, joints, name.velocity, "
          "name.acceleration, and\n"
          "gripper, where it does anything (what it begins to do up to the row's time).")
      .def(
          "to_joint_trajectory", &motion_message,
          "A dict shaped like a ROS trajectory_msgs/JointTrajectory, with base_pose and base_twist at every point, and "
          "`gripper`\n"
          "on the same clock.")
      .def("__len__", [](const M& t) { return t.times.size(); })
      .def("__repr__", [](const M& t) {
        return "RobotMotion(" + std::to_string(t.times.size()) + " points, " +
               std::string(py::repr(py::float_(t.duration()))) + " s, " + std::to_string(t.gripper.size()) +
               " gripper events)";
      });
  m.def("_drive_along", &drive_along, "poses"_a, "robot"_a, "joints"_a, "configuration"_a, "period"_a);
}

}  // namespace mmgrasp::python
