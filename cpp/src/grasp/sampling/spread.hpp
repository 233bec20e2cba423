#pragma once

#include <Eigen/Core>
#include <vector>

#include "mmgrasp/grasp/grasp.hpp"

namespace mmgrasp::detail {

/// A grasp to choose from.
struct SampledGrasp {
  Grasp grasp;
  int bin = 0;  ///< Its direction, coarsely: grasps of one bin are alike.
};

/// Rotation with R * from_a = to_a and R * from_b = to_b for two orthonormal pairs.
Eigen::Matrix3d align_axes(const Eigen::Vector3d& from_a, const Eigen::Vector3d& from_b, const Eigen::Vector3d& to_a,
                           const Eigen::Vector3d& to_b);

/// One of the 26 directions to a cube's face middles, edges and corners, nearest to a unit vector.
int direction_bin(const Eigen::Vector3d& direction);

/// The best of every bin first, then the second best of every bin, and so on, up to `most`; sorted by quality.
std::vector<Grasp> keep_spread(const std::vector<SampledGrasp>& candidates, int most);

}  // namespace mmgrasp::detail
