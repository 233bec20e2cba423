#pragma once

#include "mmgrasp/core/pose.hpp"

namespace mmgrasp::detail {

/// A frame on the plane normal . x = offset (`normal` unit): z along the normal, so that heights are z.
inline Pose plane_frame(const Eigen::Vector3d& normal, double offset) {
  Pose T = Pose::Identity();
  int axis = 0;
  normal.cwiseAbs().minCoeff(&axis);
  const Eigen::Vector3d x = (Eigen::Vector3d::Unit(axis) - normal[axis] * normal).normalized();
  T.linear() << x, normal.cross(x), normal;
  T.translation() = offset * normal;
  return T;
}

}  // namespace mmgrasp::detail
