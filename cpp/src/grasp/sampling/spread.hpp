#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace mmgrasp::detail {

/// What is known of a grasp while others are still sampled: it is made when it is kept.
struct RankedCandidate {
  double quality = 0;
  int bin = 0;  ///< Its direction, coarsely: grasps of one bin are alike.
};

/// Rotation with R * from_a = to_a and R * from_b = to_b for two orthonormal pairs.
Eigen::Matrix3d align_axes(const Eigen::Vector3d& from_a, const Eigen::Vector3d& from_b, const Eigen::Vector3d& to_a,
                           const Eigen::Vector3d& to_b);

/// One of the 26 directions to a cube's face middles, edges and corners, nearest to a unit vector.
int direction_bin(const Eigen::Vector3d& direction);

/// The best of every bin first, then the second best of every bin, and so on, up to `most`: which they are, sorted by
/// quality.
std::vector<std::size_t> keep_spread(const std::vector<RankedCandidate>& candidates, int most);

}  // namespace mmgrasp::detail
