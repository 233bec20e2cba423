#pragma once

#include <Eigen/Core>

namespace mmgrasp::detail {

/// A corner of the difference of two bodies, with the points it comes from.
struct SimplexPoint {
  Eigen::Vector3d w, on_a, on_b;
};

/// Up to four corners and the point of their hull closest to the origin: the distance sub-problem of GJK.
class Simplex {
 public:
  void add(const SimplexPoint& p) { points_[size_++] = p; }
  /// True when the corner is there already: the search cannot go on.
  bool holds(const Eigen::Vector3d& w) const;
  /// Keeps the smallest face that carries the closest point. True when a tetrahedron holds the origin.
  bool reduce();
  const Eigen::Vector3d& closest() const { return closest_; }
  /// The closest point of each body, by the weights of the last reduce().
  void witness(Eigen::Vector3d& on_a, Eigen::Vector3d& on_b) const;

 private:
  SimplexPoint points_[4];
  double weights_[4] = {1, 0, 0, 0};
  Eigen::Vector3d closest_ = Eigen::Vector3d::Zero();
  int size_ = 0;
};

}  // namespace mmgrasp::detail
