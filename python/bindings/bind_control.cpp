#include "bindings.hpp"
#include "mmgrasp/control/base_tracking.hpp"
#include "mmgrasp/control/unicycle.hpp"

namespace mmgrasp::python {
namespace {

using namespace py::literals;

const std::vector<OptionField<BaseTrackingOptions>>& tracking_fields() {
  using O = BaseTrackingOptions;
  static const std::vector<OptionField<O>> fields{
      option<O>("kp", &O::kp, "proportional gain [1/s]"),
      option<O>("ki", &O::ki, "integral gain [1/s^2]"),
      option<O>("kd", &O::kd, "derivative gain"),
      option<O>("offset", &O::offset, "distance of the tracked point from the wheel axis [m]"),
      option<O>("period", &O::period, "a command is held this long [s]"),
      option<O>("feed_forward", &O::feed_forward, "adds the planned velocity"),
      option<O>("feedback", &O::feedback, "False: open loop, the planned velocities only"),
      option<O>("settle", &O::settle, "goes on this long after the plan's end [s]")};
  return fields;
}

/// How to track and what disturbs it: the keywords of track_base.
struct TrackingRun {
  BaseTrackingOptions options;
  BaseDisturbance disturbance;
  void check() const {
    options.check();
    disturbance.check();
  }
};

OptionField<TrackingRun> triple(const char* name, Eigen::Vector3d BaseDisturbance::*member, const char* help) {
  return {name, "numpy.typing.ArrayLike",
          [=](TrackingRun& run, const py::handle& value) { run.disturbance.*member = vector3_argument(value, name); },
          [=](const TrackingRun& run) -> py::object {
            const Eigen::Vector3d& v = run.disturbance.*member;
            return py::make_tuple(v.x(), v.y(), v.z());
          },
          help};
}

const std::vector<OptionField<TrackingRun>>& run_fields() {
  using D = BaseDisturbance;
  using R = TrackingRun;
  static const std::vector<OptionField<R>> fields = [] {
    std::vector<OptionField<R>> all;
    for (const OptionField<BaseTrackingOptions>& field : tracking_fields()) {
      all.push_back({field.name, field.type,
                     [field](R& run, const py::handle& value) { field.set(run.options, value); },
                     [field](const R& run) { return field.get(run.options); }, field.help});
    }
    all.push_back(option<R>("slip_left", &R::disturbance, &D::slip_left, "share of the left wheel's travel lost"));
    all.push_back(option<R>("slip_right", &R::disturbance, &D::slip_right, "the same of the right wheel"));
    all.push_back(triple("drift", &D::drift, "platform velocity added [m/s, m/s, rad/s]"));
    all.push_back(option<R>("travel_noise", &R::disturbance, &D::travel_noise,
                            "deviation of a wheel's travel after 1 m [m], growing with the root of the travel"));
    all.push_back(
        option<R>("position_noise", &R::disturbance, &D::position_noise, "deviation of a measured x or y [m]"));
    all.push_back(
        option<R>("heading_noise", &R::disturbance, &D::heading_noise, "deviation of a measured heading [rad]"));
    all.push_back(triple("start_error", &D::start_error, "where the base stands at first, less the plan"));
    all.push_back(option<R>("seed", &R::disturbance, &D::seed, "same seed, same run"));
    return all;
  }();
  return fields;
}

py::array_t<double> numbers(const std::vector<double>& values) {
  return py::array_t<double>(py::ssize_t(values.size()), values.data());
}

void bind_tracking_result(py::module_& m) {
  using R = BaseTrackingResult;
  py::class_<R>(m, "BaseTrackingResult", "A base driven along a plan, one row a period; poses are (x, y, theta).")
      .def_property_readonly(
          "times", [](const R& r) { return numbers(r.times); }, "(k,) [s]")
      .def_property_readonly(
          "desired", [](const R& r) { return rows_to_array(r.desired); }, "(k, 3)")
      .def_property_readonly(
          "actual", [](const R& r) { return rows_to_array(r.actual); }, "(k, 3)")
      .def_property_readonly(
          "commands", [](const R& r) { return rows_to_array(r.commands); },
          "(k - 1, 3) platform velocities (v_x, v_y, omega)")
      .def_property_readonly(
          "position_errors", [](const R& r) { return numbers(r.position_errors); }, "(k,) [m]")
      .def_property_readonly(
          "heading_errors", [](const R& r) { return numbers(r.heading_errors); }, "(k,) desired less actual [rad]")
      .def_readonly("limited", &R::limited, "Commands that were scaled down to the base's limits.")
      .def_property_readonly("mean_error", &R::mean_error, "[m]")
      .def_property_readonly("max_error", &R::max_error, "[m]")
      .def_property_readonly("final_error", &R::final_error, "[m]")
      .def(
          "to_dict",
          [](const R& r) {
            return py::dict("times"_a = r.times, "desired"_a = rows_to_array(r.desired).attr("tolist")(),
                            "actual"_a = rows_to_array(r.actual).attr("tolist")(),
                            "commands"_a = rows_to_array(r.commands).attr("tolist")(),
                            "position_errors"_a = r.position_errors, "heading_errors"_a = r.heading_errors,
                            "limited"_a = r.limited);
          },
          "As a dict of plain numbers, strings and lists, e.g. for JSON.")
      .def("__repr__", [](const R& r) {
        const auto number = [](double value) { return std::string(py::repr(py::float_(value))); };
        return "BaseTrackingResult(" + std::to_string(r.times.size()) + " samples, mean error " +
               number(r.mean_error()) + " m, final " + number(r.final_error()) + " m)";
      });
}

}  // namespace

void bind_control(py::module_& m) {
  bind_tracking_result(m);
  py::class_<BaseTracker>(
      m, "BaseTracker",
      "The feedback law that keeps a base on its plan (P1 4.12 to 4.15), one command a period.\n"
      "\n"
      "    tracker = mg.base.BaseTracker(robot)\n"
      "    velocity = tracker.command(planned_now, planned_after_period, measured)  # x, y, theta each")
      .def(py::init([](const Robot& robot, const py::kwargs& options) {
             return BaseTracker(robot.base(), robot.base_limits(),
                                read_options(tracking_fields(), options, "BaseTracker"));
           }),
           py::arg("robot"), ("For a robot on a diff_drive or omni base." + option_help(tracking_fields())).c_str())
      .def("reset", &BaseTracker::reset, "Forgets the integral of the errors, to begin another plan.")
      .def(
          "command",
          [](BaseTracker& t, const ArrayLike& desired, const ArrayLike& desired_next, const ArrayLike& measured) {
            return Eigen::Vector3d(t.command(vector3_argument(desired, "desired"),
                                             vector3_argument(desired_next, "desired_next"),
                                             vector3_argument(measured, "measured")));
          },
          py::arg("desired"), py::arg("desired_next"), py::arg("measured"),
          "Platform velocity (v_x, v_y, omega) to hold until the plan is at desired_next, one period on; poses are "
          "(x, y, theta).")
      .def_property_readonly("limited", &BaseTracker::limited, "The last command was scaled down to the limits.")
      .def_property_readonly(
          "period", [](const BaseTracker& t) { return t.options().period; }, "Time for which a command is held [s].");
  m.def(
      "track_base",
      [](const Robot& robot, const JointTrajectory& trajectory, const py::kwargs& options) {
        const TrackingRun run = read_options(run_fields(), options, "track_base");
        return interruptible(
            [&] { return track_base(trajectory, robot.base(), robot.base_limits(), run.options, run.disturbance); });
      },
      py::arg("robot"), py::arg("trajectory"),
      ("Drives the robot's base along the columns x, y, theta of a trajectory, with slip and noise (P1 4.4.2, figure "
       "4.9)." +
       option_help(run_fields()))
          .c_str());
  m.def(
      "drive_arc",
      [](const ArrayLike& pose, const ArrayLike& platform_velocity, double time) {
        return Eigen::Vector3d(
            drive_arc(vector3_argument(pose, "pose"), vector3_argument(platform_velocity, "platform_velocity"), time));
      },
      py::arg("pose"), py::arg("platform_velocity"), py::arg("time"),
      "Base pose (x, y, theta) after `time` [s] at a constant platform velocity (v_x, v_y, omega): the exact arc.");
  m.def("_tracking_option_table", [] { return option_table(run_fields()); });
}

}  // namespace mmgrasp::python
