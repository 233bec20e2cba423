#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace mmgrasp::detail {

/// A rigid transform, x_a = R x_b + t: cheaper to compose and to apply than an Eigen::Isometry3d, which also carries
/// the fourth row of its matrix.
struct Rigid {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d t = Eigen::Vector3d::Zero();

  Rigid() = default;
  Rigid(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation) : R(rotation), t(translation) {}
  explicit Rigid(const Eigen::Isometry3d& T) : R(T.linear()), t(T.translation()) {}

  Eigen::Vector3d operator*(const Eigen::Vector3d& x) const { return R * x + t; }
  Rigid operator*(const Rigid& other) const { return {R * other.R, R * other.t + t}; }
  Rigid inverse() const { return {R.transpose(), -(R.transpose() * t)}; }
  /// inverse() * other
  Rigid to(const Rigid& other) const { return {R.transpose() * other.R, R.transpose() * (other.t - t)}; }
};

}  // namespace mmgrasp::detail
