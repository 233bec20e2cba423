#pragma once

#include <Eigen/Geometry>
#include <cmath>

namespace mmgrasp::detail {

template <class Scalar>
using Vector3 = Eigen::Matrix<Scalar, 3, 1>;
template <class Scalar>
using Matrix3 = Eigen::Matrix<Scalar, 3, 3>;

/// Columns x (given, not zero), y and z: y is `towards` turned into the plane across x.
template <class Scalar>
Matrix3<Scalar> axes_across(const Vector3<Scalar>& along, const Vector3<Scalar>& towards) {
  Matrix3<Scalar> axes;
  axes.col(0) = along.normalized();
  axes.col(1) = (towards - towards.dot(axes.col(0)) * axes.col(0)).normalized();
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return axes;
}

/// Where y of a section points when nothing else is said: towards the object's z, or its x when the section runs along
/// z (within 0.06 rad).
inline Eigen::Vector3d usual_y(const Eigen::Vector3d& along) {
  const bool along_z = std::abs(along.normalized().z()) > std::cos(0.06);
  return along_z ? Eigen::Vector3d::UnitX() : Eigen::Vector3d::UnitZ();
}

/// Axes of a section with its usual y.
inline Eigen::Matrix3d section_axes(const Eigen::Vector3d& along) {
  return axes_across<double>(along, usual_y(along));
}

}  // namespace mmgrasp::detail
