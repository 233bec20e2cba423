#include <optional>

#include "bindings.hpp"
#include "given.hpp"
#include "mmgrasp/plan/time_parameterization.hpp"
#include "plan_arguments.hpp"

namespace mmgrasp::python {
namespace {

using namespace py::literals;
using Strings = std::vector<std::string>;

const std::vector<OptionField<TimingOptions>>& timing_fields() {
  using O = TimingOptions;
  static const std::vector<OptionField<O>> fields{
      option<O>("max_deviation", &O::max_deviation, "corners are blended within this joint distance [rad]"),
      option<O>("sample_period", &O::sample_period, "spacing of the samples [s]"),
      {"jerk_limits", "numpy.typing.ArrayLike | None",
       [](O& o, const py::handle& v) {
         o.jerk_limits = v.is_none() ? Eigen::VectorXd() : vector_argument(v, "jerk_limits");
       },
       [](const O&) { return py::object(py::none()); }, "of each joint [rad/s^3]; None: no such limits"}};
  return fields;
}

}  // namespace

void bind_timing(py::module_& m) {
  m.def("_timing_option_table", [] { return option_table(timing_fields()); });
  m.def(
      "time_parameterize",
      [](const ArrayLike& path, const ArrayLike& velocity_limits, const ArrayLike& acceleration_limits,
         const Given<Strings>& given_names, const Progress& progress, const py::kwargs& options) {
        const TimingOptions read = read_options(timing_fields(), options, "time_parameterize");
        const JointPath waypoints{rows_argument(path, "path")};
        const Eigen::Index n = waypoints.waypoints.empty() ? -1 : waypoints.waypoints[0].size();
        const Eigen::VectorXd velocity = vector_argument(velocity_limits, "velocity_limits", n);
        const Eigen::VectorXd acceleration = vector_argument(acceleration_limits, "acceleration_limits", n);
        const Strings names = taken(given_names, "names", "names of joints");
        return LongCall(progress).run([&](const Monitor& monitor) {
          return time_parameterize(waypoints, velocity, acceleration, read, names, monitor);
        });
      },
      "path"_a, "velocity_limits"_a, "acceleration_limits"_a, py::kw_only(), "names"_a = Strings{},
      "progress"_a = py::none(),
      ("Near time-optimal timing of waypoints (k, n), at rest at both ends; corners are blended, which may leave the "
       "path\n"
       "by max_deviation." +
       option_help(timing_fields()))
          .c_str());
  m.def(
      "time_parameterize_free",
      [](const Given<CollisionChecker>& given_checker, const ArrayLike& path, const Given<double>& given_step,
         const Progress& progress, const py::kwargs& options) {
        CollisionChecker checker = taken(given_checker, "checker").clone();
        const TimingOptions read = read_options(timing_fields(), options, "time_parameterize_free");
        const JointPath waypoints{rows_argument(path, "path", checker.group().size())};
        const double joint_step = taken(given_step, "joint_step");
        return LongCall(progress).run([&](const Monitor& monitor) {
          return time_parameterize_free(checker, waypoints, read, joint_step, monitor);
        });
      },
      "checker"_a, "path"_a, py::kw_only(), "joint_step"_a = 0.01, "progress"_a = py::none(),
      ("time_parameterize under the limits of the checker's group, the blended corners checked for collisions too, no "
       "joint moving\nmore than joint_step between two checks [rad or m]. Without any times when the straight edges of "
       "the path are not free." +
       option_help(timing_fields()))
          .c_str());
}

}  // namespace mmgrasp::python
