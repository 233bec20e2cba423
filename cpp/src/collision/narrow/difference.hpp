#pragma once

#include "collision/narrow/convex.hpp"
#include "collision/narrow/simplex.hpp"

namespace mmgrasp::detail {

/// The corner of a - b, cores only, that lies farthest against `axis` (frame of a).
inline SimplexPoint difference(const Convex& a, const Convex& b, const Rigid& b_in_a, const Eigen::Vector3d& axis) {
  SimplexPoint p;
  p.on_a = a.support(-axis);
  p.on_b = b_in_a * b.support(b_in_a.R.transpose() * axis);
  p.w = p.on_a - p.on_b;
  return p;
}

/// Clearance taken for touching: rounding of coordinates as large as those of w, which spans both bodies when they
/// overlap.
inline double touching_clearance(const SimplexPoint& p) {
  return 1e-12 * (1e-3 + p.w.lpNorm<1>() + p.on_a.lpNorm<1>());
}

}  // namespace mmgrasp::detail
