#pragma once

#include <Eigen/Core>

#include "mmgrasp/robot/planar_base.hpp"

namespace mmgrasp::detail {

/// Whether a base pose (x, y, theta) lies in the square that the limits allow.
inline bool in_workspace(const BaseLimits& limits, const Eigen::Vector3d& pose) {
  return pose.head<2>().cwiseAbs().maxCoeff() <= limits.workspace + 1e-9;  // false for NaN
}

}  // namespace mmgrasp::detail
