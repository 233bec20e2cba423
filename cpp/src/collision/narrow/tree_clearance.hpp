#pragma once

#include "collision/narrow/convex_clearance.hpp"
#include "collision/narrow/solid.hpp"

namespace mmgrasp::detail {

/// Smallest clearance between the pieces (triangles, voxels) of a and of b placed at `b_in_a`; a convex body counts as
/// one piece, at least one of the two is no convex body. False when nothing is nearer than `bound`; `clearance` is then
/// left alone. Pieces that touch give 0. `axis` (frame of a, from b to a): a good guess of where the clearance lies, or
/// zero.
bool tree_clearance(const Solid& a, const Solid& b, const Rigid& b_in_a, double bound, const Eigen::Vector3d& axis,
                    ConvexClearance& clearance);

/// Euclidean distance of two boxes from below: along the face normals of either.
inline double box_clearance(const Eigen::Vector3d& half_a, const Eigen::Vector3d& half_b, const Eigen::Matrix3d& R,
                            const Eigen::Matrix3d& abs_R, const Eigen::Vector3d& t) {
  const Eigen::Vector3d along_a = (t.cwiseAbs() - half_a - abs_R * half_b).cwiseMax(0);
  const Eigen::Vector3d along_b = ((R.transpose() * t).cwiseAbs() - half_b - abs_R.transpose() * half_a).cwiseMax(0);
  return std::sqrt(std::max(along_a.squaredNorm(), along_b.squaredNorm()));
}

}  // namespace mmgrasp::detail
