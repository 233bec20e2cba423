#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace mmgrasp::detail {

/// Longest step of the joint that moves most, along a straight edge with the joint motions `delta`, with which no joint
/// moves more than `joint_step` [rad or m] and no point more than `workspace_step` [m] in one step. `motion_bounds`:
/// see mmgrasp::motion_bounds(); not read when `workspace_step` is infinite.
inline double edge_step(const Eigen::VectorXd& delta, const Eigen::VectorXd& motion_bounds, double joint_step,
                        double workspace_step) {
  const double largest = delta.lpNorm<Eigen::Infinity>();
  if (largest == 0 || !std::isfinite(workspace_step)) return joint_step;
  const double motion = motion_bounds.dot(delta.cwiseAbs());
  return std::min(joint_step, largest * workspace_step / motion);
}

/// Pieces that an edge is cut into so that the joint that moves most, by `largest`, moves no more than `step` in each;
/// a quotient within rounding of a whole number counts as that number.
inline double edge_pieces(double largest, double step) {
  return std::ceil(largest / step - 1e-9);
}

}  // namespace mmgrasp::detail
