#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "mmgrasp/verify/plan_to_check.hpp"

namespace mmgrasp::verify::detail {

/// Lowest and highest value of something over a stretch of time.
struct Range {
  double low = 0, high = 0;
};

/// The cubic between samples `index` and `index + 1` of a motion, one joint at a time.
class HermiteSegment {
 public:
  HermiteSegment(const CheckedMotion& motion, std::size_t index);

  double duration() const { return h_; }
  Eigen::VectorXd at(double s) const;     ///< s in [0, 1].
  Range position_range(int joint) const;  ///< Exact: ends and the roots of the velocity.
  Range velocity_range(int joint) const;  ///< Exact: ends and the vertex.
  double travel(int joint) const;         ///< It moves no farther than this: its highest speed times the duration.
  /// The least constant bound on acceleration with which any motion can join the two samples: |v1 - v0| / h, and more
  /// when the positions do not fit the velocities. Zero when the samples say exactly uniform motion.
  double needed_acceleration(int joint) const;

 private:
  const CheckedMotion& motion_;
  std::size_t i_;
  double h_;
  double p0(int j) const { return motion_.positions[i_][j]; }
  double p1(int j) const { return motion_.positions[i_ + 1][j]; }
  double v0(int j) const { return motion_.velocities[i_][j]; }
  double v1(int j) const { return motion_.velocities[i_ + 1][j]; }
  double position(int j, double s) const;
};

}  // namespace mmgrasp::verify::detail
