#pragma once

#include <Eigen/Core>
#include <vector>

#include "mmgrasp/robot/joint.hpp"

namespace mmgrasp::detail {

/// How far a body reaches: round shapes in closed form, meshes by their vertices.
class FarFace {
 public:
  explicit FarFace(const std::vector<LinkShape>& body);

  /// The largest direction . x over the body [m]; `direction` is a unit vector in the body's frame.
  double operator()(const Eigen::Vector3d& direction) const;

 private:
  std::vector<LinkShape> primitives_;
  Eigen::Matrix3Xd vertices_;  // Those of all meshes.
};

}  // namespace mmgrasp::detail
