#pragma once

#include <Eigen/Geometry>
#include <cmath>

namespace mmgrasp::detail {

/// Columns x (given, not zero), y and z: y is `towards` turned into the plane across x.
inline Eigen::Matrix3d axes_across(const Eigen::Vector3d& along, const Eigen::Vector3d& towards) {
  Eigen::Matrix3d axes;
  axes.col(0) = along.normalized();
  axes.col(1) = (towards - towards.dot(axes.col(0)) * axes.col(0)).normalized();
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return axes;
}

/// The same with y towards the object's z, or its x when x runs along z (within 0.06 rad).
inline Eigen::Matrix3d section_axes(const Eigen::Vector3d& along) {
  const bool along_z = std::abs(along.normalized().z()) > std::cos(0.06);
  return axes_across(along, along_z ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitZ());
}

}  // namespace mmgrasp::detail
