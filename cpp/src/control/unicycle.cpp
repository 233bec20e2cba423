#include "mmgrasp/control/unicycle.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"

namespace mmgrasp {
namespace {

/// sin(x) / x
double sinc(double x) {
  return std::abs(x) < 1e-4 ? 1 - x * x / 6 : std::sin(x) / x;
}

void check_finite(const Eigen::Vector3d& v, const char* field) {
  const char* parts[] = {"[0]", "[1]", "[2]"};
  for (int i = 0; i < 3; ++i) require_number(v[i], std::string(field) + parts[i]);
}

}  // namespace

Eigen::Vector3d drive_arc(const Eigen::Vector3d& pose, const Eigen::Vector3d& platform_velocity, double time) {
  check_finite(pose, "pose");
  check_finite(platform_velocity, "platform_velocity");
  require_not_negative(time, "time");
  const double turn = platform_velocity.z() * time;
  Eigen::Vector3d result = pose;
  result.head<2>() += time * sinc(turn / 2) * (Eigen::Rotation2Dd(pose.z() + turn / 2) * platform_velocity.head<2>());
  result.z() += turn;
  return result;
}

Eigen::Vector3d arc_velocity(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double time) {
  check_finite(from, "from");
  check_finite(to, "to");
  require_positive(time, "time");
  const double turn = to.z() - from.z();
  require(std::abs(turn) < detail::kTwoPi, "to[2]", to.z(), "must lie less than a full turn from from[2]");
  Eigen::Vector3d velocity;
  velocity.head<2>() = Eigen::Rotation2Dd(-(from.z() + turn / 2)) * (to - from).head<2>() / (time * sinc(turn / 2));
  velocity.z() = turn / time;
  return velocity;
}

}  // namespace mmgrasp
