#include "bindings.hpp"
#include "mmgrasp/robot/trajectory.hpp"
#include "motion_message.hpp"

namespace mmgrasp::python {
namespace {

using namespace py::literals;

std::vector<Eigen::VectorXd> samples_argument(const py::handle& value, const char* name, std::size_t rows,
                                              Eigen::Index columns) {
  std::vector<Eigen::VectorXd> read = rows_argument(value, name, columns);
  if (read.size() != rows) {
    throw InvalidInput(std::string(name) + ": has shape (" + std::to_string(read.size()) + ", " +
                       std::to_string(columns) + "), must have a row for each of the " + std::to_string(rows) +
                       " times");
  }
  return read;
}

JointTrajectory make_trajectory(const std::vector<std::string>& names, const ArrayLike& times,
                                const ArrayLike& positions, const OptionalArray& velocities,
                                const OptionalArray& accelerations) {
  JointTrajectory t;
  t.names = names;
  const Eigen::VectorXd clock = vector_argument(times, "times");
  t.times.assign(clock.data(), clock.data() + clock.size());
  if (t.times.empty()) throw InvalidInput("times: has shape (0,), must hold at least one time");
  if (t.times[0] != 0) throw InvalidInput("times[0] = " + text(clock.head(1)) + ": must be 0");
  for (Eigen::Index i = 1; i < clock.size(); ++i) {
    if (!(clock[i] > clock[i - 1])) {
      throw InvalidInput("times: has shape (" + std::to_string(clock.size()) + ",), times[" + std::to_string(i) +
                         "] = " + text(clock.segment(i, 1)) + " must be later than the time before");
    }
  }
  const auto columns = static_cast<Eigen::Index>(names.size());
  t.positions = samples_argument(positions, "positions", t.times.size(), columns);
  if (!velocities.is_none()) t.velocities = samples_argument(velocities, "velocities", t.times.size(), columns);
  if (!accelerations.is_none()) {
    if (velocities.is_none()) throw InvalidInput("accelerations: need velocities too");
    t.accelerations = samples_argument(accelerations, "accelerations", t.times.size(), columns);
  }
  return t;
}

}  // namespace

void bind_trajectory(py::module_& m) {
  py::class_<JointTrajectory>(
      m, "JointTrajectory",
      "A path on a clock; cubic Hermite between samples.\n"
      "\n"
      "    motion = mg.time_parameterize(path, arm.velocity_limits, arm.acceleration_limits, names=arm.names)\n"
      "    q = motion.at(motion.duration / 2)\n"
      "    motion.to_csv()")
      .def(py::init(&make_trajectory), py::arg("names"), py::arg("times"), py::arg("positions"),
           py::arg("velocities") = py::none(), py::arg("accelerations") = py::none(),
           "From samples: times (k,) from 0 and increasing [s], positions (k, n), and if given velocities and "
           "accelerations\n"
           "(k, n). Without velocities the samples are joined by straight lines.")
      .def_readonly("names", &JointTrajectory::names, "One a column.")
      .def_property_readonly(
          "times",
          [](const JointTrajectory& t) { return py::array_t<double>(py::ssize_t(t.times.size()), t.times.data()); },
          "(k,) [s]")
      .def_property_readonly(
          "positions", [](const JointTrajectory& t) { return rows_to_array(t.positions); }, "(k, n)")
      .def_property_readonly(
          "velocities", [](const JointTrajectory& t) { return rows_to_array(t.velocities); },
          "(k, n) [rad/s or m/s]; (0, 0) when not known.")
      .def_property_readonly(
          "accelerations", [](const JointTrajectory& t) { return rows_to_array(t.accelerations); },
          "(k, n) [rad/s^2 or m/s^2]; (0, 0) when not known.")
      .def_property_readonly("duration", &JointTrajectory::duration, "[s]")
      .def("at", &JointTrajectory::at, py::arg("time"), "Configuration (n,) at a time [s], clamped at the ends.")
      .def(
          "to_csv",
          [](const JointTrajectory& t, const OptionalArray& base_pose) {
            const auto pose = base_pose_argument(base_pose);
            return interruptible([&] { return pose ? robot_motion(t, pose).to_csv() : t.to_csv(); });
          },
          py::arg("base_pose") = py::none(),
          "Header time, names, name.velocity, ...; one line a sample. With base_pose (x, y, theta) of the standing "
          "base, as\n"
          "RobotMotion writes it.")
      .def(
          "to_joint_trajectory",
          [](const JointTrajectory& t, const OptionalArray& base_pose) {
            return motion_message(robot_motion(t, base_pose_argument(base_pose)));
          },
          py::arg("base_pose") = py::none(),
          "RobotMotion's message: columns x, y, theta in front are the base's; without them it stands at base_pose.")
      .def(
          "to_dict",
          [](const JointTrajectory& t) {
            return py::dict("names"_a = t.names, "times"_a = t.times,
                            "positions"_a = rows_to_array(t.positions).attr("tolist")(),
                            "velocities"_a = rows_to_array(t.velocities).attr("tolist")(),
                            "accelerations"_a = rows_to_array(t.accelerations).attr("tolist")());
          },
          "As a dict of plain numbers, strings and lists, e.g. for JSON.")
      .def("__len__", [](const JointTrajectory& t) { return t.times.size(); })
      .def("__repr__", [](const JointTrajectory& t) {
        return "JointTrajectory(" + std::to_string(t.times.size()) + " samples, " +
               std::string(py::repr(py::float_(t.duration()))) + " s)";
      });
}

}  // namespace mmgrasp::python
