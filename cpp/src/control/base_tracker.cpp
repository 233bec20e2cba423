// BaseTracker: the feedback law that follows a planned base motion.
#include <Eigen/Geometry>
#include <cmath>

#include "mmgrasp/control/base_tracking.hpp"
#include "mmgrasp/control/unicycle.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/robot/base_motion.hpp"

namespace mmgrasp {
namespace {

constexpr double kStanding = 1e-9;  // below this speed a plan drives neither forwards nor backwards [m/s]

void check_not_negative(double value, const char* field) {
  require_not_negative(value, field);
}

Eigen::Vector2d point(const Eigen::Vector3d& pose, double offset) {
  return pose.head<2>() + offset * Eigen::Vector2d(std::cos(pose.z()), std::sin(pose.z()));
}

}  // namespace

void BaseTrackingOptions::check() const {
  check_not_negative(kp, "kp");
  check_not_negative(ki, "ki");
  check_not_negative(kd, "kd");
  require_positive(offset, "offset");
  require_positive(period, "period");
  check_not_negative(settle, "settle");
}

BaseTracker::BaseTracker(BaseKind kind, const BaseLimits& limits, const BaseTrackingOptions& options)
    : kind_(kind), limits_(limits), options_(options) {
  require(kind != BaseKind::fixed, "kind", to_string(kind), "must be diff_drive or omni: a fixed base follows nothing");
  limits.check();
  options.check();
}

void BaseTracker::reset() {
  integral_.setZero();
  last_error_.setZero();
  has_error_ = limited_ = false;
  side_ = 1;
}

Eigen::Vector3d BaseTracker::correction(const Eigen::Vector3d& error) {
  const Eigen::Vector3d slope =
      has_error_ ? Eigen::Vector3d((error - last_error_) / options_.period) : Eigen::Vector3d::Zero();
  if (!limited_) integral_ += options_.period * error;
  last_error_ = error;
  has_error_ = true;
  return options_.kp * error + options_.ki * integral_ + options_.kd * slope;
}

Eigen::Vector3d BaseTracker::command(const Eigen::Vector3d& desired, const Eigen::Vector3d& desired_next,
                                     const Eigen::Vector3d& measured) {
  for (int i = 0; i < 3; ++i) require_number(measured[i], "measured[" + std::to_string(i) + "]");
  Eigen::Vector3d planned = arc_velocity(desired, desired_next, options_.period);
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  if (kind_ == BaseKind::diff_drive) {
    planned.y() = 0;
    if (std::abs(planned.x()) > kStanding && std::signbit(planned.x()) != std::signbit(side_)) {
      side_ = -side_;
      has_error_ = false;  // the point jumps: its error has no slope here
    }
    const double offset = side_ * options_.offset;
    const Eigen::Rotation2Dd to_platform(-measured.z());
    Eigen::Vector2d rate = Eigen::Vector2d::Zero();
    if (options_.feed_forward)
      rate = Eigen::Rotation2Dd(desired.z() - measured.z()) * Eigen::Vector2d(planned.x(), offset * planned.z());
    if (options_.feedback) {
      Eigen::Vector3d error = Eigen::Vector3d::Zero();
      error.head<2>() = point(desired, offset) - point(measured, offset);
      rate += to_platform * correction(error).head<2>();
      velocity = {rate.x(), 0, rate.y() / offset};
    } else if (options_.feed_forward) {
      velocity = planned;
    }
  } else {
    if (options_.feed_forward) velocity = planned;
    if (options_.feedback) {
      if (options_.feed_forward)  // the plan's velocity is one in the world, wherever the platform looks
        velocity.head<2>() = Eigen::Rotation2Dd(desired.z() - measured.z()) * velocity.head<2>();
      Eigen::Vector3d error = desired - measured;
      error.z() = wrap_angle(error.z());
      velocity += platform_velocity(measured.z(), correction(error));
    }
  }
  const double scale = velocity_scale(kind_, limits_, velocity);
  limited_ = scale < 1;
  return scale * velocity;
}

}  // namespace mmgrasp
