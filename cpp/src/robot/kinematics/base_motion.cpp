#include "mmgrasp/robot/base_motion.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"

namespace mmgrasp {
namespace {

constexpr double kSideways = 1e-9;  // share of the rest of a velocity that rounding may put sideways

Eigen::Vector3d turned(double angle, const Eigen::Vector3d& v) {
  Eigen::Vector3d result = v;
  result.head<2>() = Eigen::Rotation2Dd(angle) * v.head<2>();
  return result;
}

void check_finite(double value, const char* field) {
  require_number(value, field);
}

void check_velocity(const Eigen::Vector3d& velocity, const char* field) {
  const char* parts[] = {"[0]", "[1]", "[2]"};
  for (int i = 0; i < 3; ++i) require_number(velocity[i], std::string(field) + parts[i]);
}

void check_separation(double wheel_separation) {
  require_positive(wheel_separation, "wheel_separation");
}

}  // namespace

Eigen::Vector3d platform_velocity(double theta, const Eigen::Vector3d& joint_velocity) {
  check_finite(theta, "theta");
  check_velocity(joint_velocity, "joint_velocity");
  return turned(-theta, joint_velocity);
}

Eigen::Vector3d joint_velocity(double theta, const Eigen::Vector3d& platform_velocity) {
  check_finite(theta, "theta");
  check_velocity(platform_velocity, "platform_velocity");
  return turned(theta, platform_velocity);
}

WheelSpeeds wheel_speeds(double v, double omega, double wheel_separation) {
  check_finite(v, "v");
  check_finite(omega, "omega");
  check_separation(wheel_separation);
  const double turning = 0.5 * omega * wheel_separation;
  return {v - turning, v + turning};
}

Eigen::Vector3d platform_velocity(const WheelSpeeds& wheels, double wheel_separation) {
  check_finite(wheels.left, "wheels.left");
  check_finite(wheels.right, "wheels.right");
  check_separation(wheel_separation);
  return {0.5 * (wheels.left + wheels.right), 0, (wheels.right - wheels.left) / wheel_separation};
}

WheelRows wheel_rows(BaseKind kind, const BaseLimits& limits) {
  if (!std::isfinite(limits.wheel_velocity)) return WheelRows(0, 3);
  if (kind == BaseKind::diff_drive) {
    const double lever = 0.5 * limits.wheel_separation;
    WheelRows rows(2, 3);
    rows << 1, 0, -lever, 1, 0, lever;
    return rows;
  }
  if (kind != BaseKind::omni || limits.wheelbase <= 0) return WheelRows(0, 3);
  const double lever = 0.5 * (limits.wheel_separation + limits.wheelbase);
  WheelRows rows(4, 3);
  rows << 1, -1, -lever, 1, 1, lever, 1, 1, -lever, 1, -1, lever;
  return rows;
}

double largest_rim_travel(const WheelRows& rows, double theta, const Eigen::Vector3d& way) {
  check_finite(theta, "theta");
  check_velocity(way, "way");
  const double length = way.head<2>().norm(), last = theta + way.z();
  double most = 0;
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    // The rim is a sinusoid of the heading about what turning asks: it is extreme at both ends, or where that peaks.
    const double amplitude = length * rows.row(i).head<2>().norm(), turning = rows(i, 2) * way.z();
    const double peak = std::atan2(way.y(), way.x()) - std::atan2(rows(i, 1), rows(i, 0));
    for (const double heading : {theta, last})
      most = std::max(most, std::abs(amplitude * std::cos(heading - peak) + turning));
    const double first = std::ceil((std::min(theta, last) - peak) / detail::kPi);  // in halves of a turn from the peak
    for (const double half : {first, first + 1}) {
      if (peak + half * detail::kPi > std::max(theta, last)) break;
      const double sign = std::fmod(half, 2) == 0 ? 1 : -1;
      most = std::max(most, std::abs(sign * amplitude + turning));
    }
  }
  return most;
}

double velocity_scale(BaseKind kind, const BaseLimits& limits, const Eigen::Vector3d& platform_velocity) {
  limits.check();
  check_velocity(platform_velocity, "platform_velocity");
  const double speed = platform_velocity.head<2>().norm(), turning = std::abs(platform_velocity.z());
  if (speed == 0 && turning == 0) return 1;
  if (kind == BaseKind::fixed) return 0;
  double scale = 1;
  const auto keep = [&scale](double value, double limit) {
    if (value > limit) scale = std::min(scale, limit / value);
  };
  keep(speed, limits.linear_velocity);
  keep(turning, limits.angular_velocity);
  if (kind == BaseKind::diff_drive) {
    const double rest = std::max(std::abs(platform_velocity.x()), turning);
    if (std::abs(platform_velocity.y()) > kSideways * rest) return 0;
    const WheelSpeeds wheels = wheel_speeds(platform_velocity.x(), platform_velocity.z(), limits.wheel_separation);
    keep(std::max(std::abs(wheels.left), std::abs(wheels.right)), limits.wheel_velocity);
  } else if (const WheelRows rows = wheel_rows(kind, limits); rows.rows() > 0) {
    keep((rows * platform_velocity).cwiseAbs().maxCoeff(), limits.wheel_velocity);
  }
  return scale;
}

BaseLimits driving_limits(BaseKind kind, const BaseLimits& limits) {
  BaseLimits result = limits;
  result.linear_velocity *= velocity_scale(kind, limits, {limits.linear_velocity, 0, 0});
  result.angular_velocity *= velocity_scale(kind, limits, {0, 0, limits.angular_velocity});
  return result;
}

}  // namespace mmgrasp
