#pragma once

#include <Eigen/Geometry>

namespace mmgrasp::detail {

/// A rotation whose z is the unit vector `axis`, turned by no more than a right angle from z or, the other way up, from
/// -z: Eigen's own way from one vector to another loses half of the digits where they are opposite.
inline Eigen::Matrix3d frame_along(const Eigen::Vector3d& axis) {
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  if (axis.z() >= 0) return Eigen::Quaterniond::FromTwoVectors(z, axis).toRotationMatrix();
  const Eigen::Matrix3d upside_down = Eigen::Vector3d(1, -1, -1).asDiagonal();
  return Eigen::Quaterniond::FromTwoVectors(-z, axis).toRotationMatrix() * upside_down;
}

}  // namespace mmgrasp::detail
