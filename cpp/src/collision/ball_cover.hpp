#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "collision/kernels.hpp"
#include "mmgrasp/geometry/shape.hpp"

namespace mmgrasp::detail {

struct Solid;

/// Balls that cover a body, and balls within it: what misses the former is apart, what meets the latter overlaps.
class BallCover {
 public:
  /// `inner` is the radius of a ball about the same centre that lies within the body, negative when there is none.
  void add(const Eigen::Vector3d& centre, double outer, double inner);
  /// Rounds up to whole vectors. Nothing may be added afterwards.
  void finish();

  bool empty() const { return filled_ == 0; }
  CoverView view() const;
  /// Largest coordinate or radius: what single precision rounds against [m].
  float extent() const { return extent_; }

 private:
  std::vector<float> data_[5];
  int filled_ = 0;
  float extent_ = 0;
};

/// Covers the body the solid was made of (without padding): the bounding box is cut into cells, each cell's part of the
/// body gets a ball. Empty for planes and voxels.
BallCover cover_body(const Solid& solid, const Shape& shape);

}  // namespace mmgrasp::detail
