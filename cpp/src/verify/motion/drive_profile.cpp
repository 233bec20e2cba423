#include "verify/motion/drive_profile.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::verify::detail {
namespace {

/// How far the fastest of four Mecanum wheels runs per share of a straight piece [m], at the heading on it that asks
/// the most of it: |v_x| + |v_y| + |omega| (track + wheelbase) / 2, of which |cos| + |sin| of the direction seen from
/// the base is largest halfway between two axes.
double mecanum_travel(const Eigen::Vector3d& from, const Eigen::Vector3d& to, const BaseLimits& limits) {
  const Eigen::Vector3d way = to - from;
  const double course = std::atan2(way.y(), way.x());
  const double least = course - std::max(from.z(), to.z()), most = course - std::min(from.z(), to.z());
  const auto share = [](double angle) { return std::abs(std::cos(angle)) + std::abs(std::sin(angle)); };
  // The first middle between two axes from `least` on.
  constexpr double kHalfRight = mmgrasp::detail::kPi / 4;
  const double middle = kHalfRight + 2 * kHalfRight * std::ceil((least - kHalfRight) / (2 * kHalfRight));
  const double worst = middle <= most ? std::sqrt(2.0) : std::max(share(least), share(most));
  return way.head<2>().norm() * worst + 0.5 * (limits.wheel_separation + limits.wheelbase) * std::abs(way.z());
}

}  // namespace

DriveProfile::DriveProfile(const Eigen::Vector3d& from, const Eigen::Vector3d& to, BaseKind base,
                           const BaseLimits& limits) {
  const double driven = (to - from).head<2>().norm(), turned = std::abs(to.z() - from.z());
  if (!(driven > 0 || turned > 0)) return;
  double speed = limits.linear_velocity, turning_rate = limits.angular_velocity;
  if (base == BaseKind::diff_drive) {  // a turn on the spot drives the wheels at half their separation
    speed = std::min(speed, limits.wheel_velocity);
    turning_rate = std::min(turning_rate, limits.wheel_velocity / (0.5 * limits.wheel_separation));
  }
  top_ = std::min(speed / driven, turning_rate / turned);  // Infinite quotients where there is no way.
  if (base == BaseKind::omni && limits.wheelbase > 0)
    top_ = std::min(top_, limits.wheel_velocity / mecanum_travel(from, to, limits));
  acceleration_ = std::min(limits.linear_acceleration / driven, limits.angular_acceleration / turned);
  if (1 < top_ * top_ / acceleration_) top_ = std::sqrt(acceleration_);  // full speed is not reached
  duration_ = 1 / top_ + top_ / acceleration_;
}

double DriveProfile::share(double time) const {
  if (time <= 0 || duration_ <= 0) return time < duration_ ? 0 : 1;
  if (time >= duration_) return 1;
  const double ramp = top_ / acceleration_, left = duration_ - time;
  if (time <= ramp) return 0.5 * acceleration_ * time * time;
  return left <= ramp ? 1 - 0.5 * acceleration_ * left * left : top_ * (time - 0.5 * ramp);
}

}  // namespace mmgrasp::verify::detail
