#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <mutex>
#include <vector>

#include "collision/kernels/kernels.hpp"
#include "collision/narrow/distance_grid.hpp"
#include "mmgrasp/geometry/shape.hpp"

namespace mmgrasp::detail {

struct Solid;

/// Rounding of the construction of covers itself, far above that of double precision.
constexpr double kCoverGrowth = 1 + 1e-6;

/// Spheres that cover a body, and spheres within it: what misses the former is apart, what meets the latter overlaps.
class SphereCover {
 public:
  /// `inner` is the radius of a sphere about the same centre that lies within the body, negative when there is none.
  void add(const Eigen::Vector3d& centre, double outer, double inner);
  /// A place that stays empty: infinitely far away.
  void add_far();
  /// Empty places up to the next whole vector.
  void pad();

  bool empty() const { return filled_ == 0; }
  CoverView view() const;
  /// Largest coordinate or radius: what single precision rounds against [m].
  float extent() const { return extent_; }

 private:
  std::vector<float> data_[5];
  int filled_ = 0;  ///< Up to the last real sphere.
  float extent_ = 0;
};

/// Covers of the same body, each finer than the one before: the spheres kLanes * i ... of a level cover what sphere i
/// of the level above covers.
using CoverLevels = std::vector<SphereCover>;

/// Bounds that stand in for a body before its exact shape is tested (padding not included).
class MMGRASP_EXPORT BoundingVolumes {
 public:
  static constexpr int kLevels = 3;

  BoundingVolumes(const Solid& solid, const Shape& shape);

  /// The bounding box cut into cells, a sphere for each cell's part of the body. Empty for planes and voxels.
  const SphereCover& cover() const { return cover_; }

  /// Cover in kLevels levels, and distances to a mesh (null for other shapes): made when first needed, each for itself,
  /// since most bodies never come that close to others and few need both. `solid` is the one it was made with. Safe
  /// from several threads.
  const CoverLevels& levels(const Solid& solid) const;
  const DistanceGrid* grid(const Solid& solid) const;

 private:
  SphereCover cover_;
  Shape shape_;                             // primitives
  std::weak_ptr<const TriangleMesh> mesh_;  // lives in the robot, which outlives the queries
  mutable std::once_flag levels_once_, grid_once_;
  mutable CoverLevels levels_;
  mutable std::unique_ptr<const DistanceGrid> grid_;
};

}  // namespace mmgrasp::detail
