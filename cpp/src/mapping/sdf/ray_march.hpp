#pragma once

#include <Eigen/Geometry>

#include "mapping/sdf/crossing_cells.hpp"

namespace mmgrasp::detail {

/// A block with cells that the surface crosses, and the part of a ray in it from the first of them on.
struct BlockOnRay {
  int block = -1;  ///< Negative: the ray meets none.
  BlockKey key;
  double begin = 0, end = 0;  ///< From the ray's origin [m].
};

/// Where a ray with a unit direction crosses the zero level from the front. Finding blocks reads flags alone, which fit
/// into the cache; so rays can be sorted by block before voxels are read. Not for several threads at once.
class RayMarch {
 public:
  RayMarch(const SdfGrid& grid, CrossingCells& crossing, SdfSampler& sampler, const Eigen::Vector3d& origin,
           const Eigen::Vector3d& direction);

  BlockOnRay first_block() const;
  /// First crossing, in this block or one behind it [m]; NaN without one.
  double crossing(BlockOnRay in) const;

 private:
  BlockOnRay next_block(double begin) const;
  double crossing_in(const BlockOnRay& in) const;
  double crossing_of(const BlockKey& cell, double begin, double end) const;
  bool from_the_front(double t) const;

  const SdfGrid& grid_;
  CrossingCells& crossing_;
  SdfSampler& sampler_;
  const Eigen::Vector3d origin_, direction_;
  const Eigen::Vector3d inverse_;  ///< 1 / direction; where that is not finite the ray leaves no cell along the axis.
  double begin_ = 0, end_ = 0;     ///< Within the map's bounds; none: begin >= end.
};

}  // namespace mmgrasp::detail
