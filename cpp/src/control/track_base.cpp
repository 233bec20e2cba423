// track_base(): a simulated base that follows a plan.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "mmgrasp/control/base_tracking.hpp"
#include "mmgrasp/control/unicycle.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/robot/base_motion.hpp"

namespace mmgrasp {
namespace {

/// The motion of a platform that slips and drifts, commanded a velocity for one period.
class SlippingBase {
 public:
  SlippingBase(BaseKind kind, const BaseLimits& limits, const BaseDisturbance& disturbance)
      : kind_(kind), separation_(limits.wheel_separation), disturbance_(disturbance), rng_(disturbance.seed, 0) {}

  Eigen::Vector3d moved(const Eigen::Vector3d& pose, const Eigen::Vector3d& command, double time) {
    Eigen::Vector3d velocity;
    if (kind_ == BaseKind::diff_drive) {
      WheelSpeeds wheels = wheel_speeds(command.x(), command.z(), separation_);
      wheels.left = disturbed(wheels.left, disturbance_.slip_left, time);
      wheels.right = disturbed(wheels.right, disturbance_.slip_right, time);
      velocity = platform_velocity(wheels, separation_);
    } else {
      const double half = separation_ / 2;
      velocity.x() = disturbed(command.x(), disturbance_.slip_left, time);
      velocity.y() = disturbed(command.y(), disturbance_.slip_left, time);
      velocity.z() = disturbed(command.z() * half, disturbance_.slip_left, time) / half;
    }
    return drive_arc(pose, velocity + disturbance_.drift, time);
  }

 private:
  double disturbed(double speed, double slip, double time) {
    const double travel = (1 - slip) * speed * time;
    const double noise = rng_.normal();
    return (travel + disturbance_.travel_noise * std::sqrt(std::abs(travel)) * noise) / time;
  }

  BaseKind kind_;
  double separation_;
  const BaseDisturbance& disturbance_;
  Rng rng_;
};

Eigen::Vector3d base_pose(const JointTrajectory& plan, const Eigen::Array3i& columns, double time) {
  const Eigen::VectorXd q = plan.at(time);
  return {q[columns[0]], q[columns[1]], q[columns[2]]};
}

void record(BaseTrackingResult& result, double time, const Eigen::Vector3d& desired, const Eigen::Vector3d& actual) {
  result.times.push_back(time);
  result.desired.push_back(desired);
  result.actual.push_back(actual);
  result.position_errors.push_back((desired - actual).head<2>().norm());
  result.heading_errors.push_back(wrap_angle(desired.z() - actual.z()));
}

constexpr double kMostSteps = 1e6;

}  // namespace

void BaseDisturbance::check() const {
  for (const auto& [slip, field] : {std::pair(slip_left, "slip_left"), std::pair(slip_right, "slip_right")})
    require(slip >= 0 && slip < 1, field, slip, "must lie in [0, 1)");
  for (int i = 0; i < 3; ++i) {
    require_number(drift[i], "drift[" + std::to_string(i) + "]");
    require_number(start_error[i], "start_error[" + std::to_string(i) + "]");
  }
  for (const auto& [noise, field] :
       {std::pair(travel_noise, "travel_noise"), std::pair(position_noise, "position_noise"),
        std::pair(heading_noise, "heading_noise")})
    require_not_negative(noise, field);
}

double BaseTrackingResult::mean_error() const {
  if (position_errors.empty()) return 0;
  return std::accumulate(position_errors.begin(), position_errors.end(), 0.0) /
         static_cast<double>(position_errors.size());
}

double BaseTrackingResult::max_error() const {
  return position_errors.empty() ? 0 : *std::max_element(position_errors.begin(), position_errors.end());
}

double BaseTrackingResult::final_error() const {
  return position_errors.empty() ? 0 : position_errors.back();
}

Eigen::Array3i base_columns(const JointTrajectory& plan) {
  Eigen::Array3i columns;
  const char* names[] = {"x", "y", "theta"};
  for (int i = 0; i < 3; ++i) {
    const auto found = std::find(plan.names.begin(), plan.names.end(), names[i]);
    require(found != plan.names.end(), "plan", "names", std::string("must have the base's column '") + names[i] + "'");
    columns[i] = static_cast<int>(found - plan.names.begin());
  }
  return columns;
}

BaseTrackingResult track_base(const JointTrajectory& plan, BaseKind kind, const BaseLimits& limits,
                              const BaseTrackingOptions& options, const BaseDisturbance& disturbance) {
  disturbance.check();
  require(!plan.times.empty(), "plan", "0 samples", "must hold at least one sample");
  require(kind != BaseKind::omni || disturbance.slip_left == disturbance.slip_right, "slip_right",
          disturbance.slip_right, "must equal slip_left for an omni base");
  BaseTracker tracker(kind, limits, options);
  const Eigen::Array3i columns = base_columns(plan);
  SlippingBase base(kind, limits, disturbance);
  Rng sensor(disturbance.seed, 1);

  const double h = options.period;
  const double wanted = std::ceil((plan.duration() + options.settle) / h - 1e-9);
  require(wanted <= kMostSteps, "period", h,
          "must be longer: at most a million commands over the plan and `settle` [s]");
  const auto steps = static_cast<std::size_t>(wanted);
  BaseTrackingResult result;
  Eigen::Vector3d desired = base_pose(plan, columns, 0);
  Eigen::Vector3d actual = desired + disturbance.start_error;
  record(result, 0, desired, actual);
  for (std::size_t k = 0; k < steps; ++k) {
    const double next_time = static_cast<double>(k + 1) * h;
    const Eigen::Vector3d next = base_pose(plan, columns, next_time);
    const Eigen::Vector3d noise(disturbance.position_noise * sensor.normal(),
                                disturbance.position_noise * sensor.normal(),
                                disturbance.heading_noise * sensor.normal());
    result.commands.push_back(tracker.command(desired, next, actual + noise));
    if (tracker.limited()) ++result.limited;
    actual = base.moved(actual, result.commands.back(), h);
    desired = next;
    record(result, next_time, desired, actual);
  }
  return result;
}

}  // namespace mmgrasp
