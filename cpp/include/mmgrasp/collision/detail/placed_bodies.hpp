#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/robot/joint.hpp"

namespace mmgrasp::detail {

/// Shapes where they are at one time, such as the links of a robot and what it holds, to be measured against those of
/// another robot. Immutable.
class MMGRASP_EXPORT PlacedBodies {
 public:
  /// `T_world_body`: one pose a shape, of the body that it belongs to. Throws InvalidInput unless there are as many.
  PlacedBodies(const std::vector<LinkShape>& shapes, const Poses& T_world_body);
  PlacedBodies(PlacedBodies&&) noexcept;
  ~PlacedBodies();

  /// Smallest distance between a shape of this one and a shape of the other [m]: exact below `within`, else infinite.
  /// Negative where two overlap.
  double distance(const PlacedBodies& other, double within) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace mmgrasp::detail
