#include "grasp/sampling/approach_direction.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "mmgrasp/grasp/sample_grasps.hpp"

namespace mmgrasp::detail {
namespace {

bool is_across(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::abs(a.dot(b)) <= std::sin(kStraightApproach);
}

bool is_along(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return a.cross(b).norm() <= std::sin(kStraightApproach);
}

}  // namespace

std::optional<Eigen::Vector3d> straight_across(const Eigen::Vector3d& axis, const Eigen::Vector3d& wanted) {
  if (!is_across(axis, wanted)) return {};
  return (wanted - axis.dot(wanted) * axis).normalized();
}

bool lies_askew(const Shape& shape, const Eigen::Vector3d& direction) {
  if (std::holds_alternative<Box>(shape)) {
    for (int i = 0; i < 3; ++i)
      if (is_along(direction, Eigen::Vector3d::Unit(i))) return false;
    return true;
  }
  if (!std::holds_alternative<Cylinder>(shape) && !std::holds_alternative<Capsule>(shape)) return false;
  const Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  return !is_along(direction, axis) && !is_across(direction, axis);
}

}  // namespace mmgrasp::detail
