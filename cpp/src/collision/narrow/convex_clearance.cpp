#include "collision/narrow/convex_clearance.hpp"

#include "collision/narrow/difference.hpp"
#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {

namespace {

constexpr int kMaxIterations = 128;

}  // namespace

ClearanceKind convex_clearance(const Convex& a, const Convex& b, const Rigid& b_in_a, double bound,
                               Eigen::Vector3d& axis, ConvexClearance& clearance) {
  const double reach = bound + a.radius + b.radius;  // of the cores
  if (!(axis.squaredNorm() > 1e-20)) axis = a.centre - b_in_a * b.centre;
  if (!(axis.squaredNorm() > 1e-20)) axis = Eigen::Vector3d::UnitX();
  Simplex simplex, last;
  double best = kInfinity;  // squared length of the simplex's closest point
  for (int i = 0; i < kMaxIterations; ++i) {
    const SimplexPoint p = difference(a, b, b_in_a, axis);
    const double along = axis.dot(p.w);
    // The whole difference lies beyond the plane through w.
    if (along > 0 && (reach <= 0 || along * along >= reach * reach * axis.squaredNorm())) return ClearanceKind::beyond;
    if (i > 0 && (best - along <= 1e-13 * best || simplex.holds(p.w))) break;
    simplex.add(p);
    if (simplex.reduce()) {
      if (along > 0 && i > 0) break;  // apart for certain: only rounding put the origin inside a flat tetrahedron
      return ClearanceKind::overlapping;
    }
    const Eigen::Vector3d closest = simplex.closest();
    const double squared = closest.squaredNorm();
    if (squared <= touching_clearance(p) * touching_clearance(p)) return ClearanceKind::overlapping;
    if (!(squared < best)) break;  // rounding stops the descent
    best = squared;
    axis = closest;
    last = simplex;
  }
  const double core = std::sqrt(best);
  if (core >= reach) return ClearanceKind::beyond;
  last.witness(clearance.on_a, clearance.on_b);
  clearance.distance = core - a.radius - b.radius;
  clearance.normal = axis / core;
  clearance.on_a -= a.radius * clearance.normal;
  clearance.on_b += b.radius * clearance.normal;
  return ClearanceKind::apart;
}

Nearness convex_nearness(const Convex& a, const Convex& b, const Rigid& b_in_a, double bound, double touch) {
  const double reach = bound + a.radius + b.radius, least = touch + a.radius + b.radius;  // of the cores
  Eigen::Vector3d axis = a.centre - b_in_a * b.centre;
  if (!(axis.squaredNorm() > 1e-20)) axis = Eigen::Vector3d::UnitX();
  Simplex simplex;
  double best = kInfinity;  // squared length of the simplex's closest point
  bool parted = false;
  for (int i = 0; i < kMaxIterations; ++i) {
    const SimplexPoint p = difference(a, b, b_in_a, axis);
    const double along = axis.dot(p.w), squared_axis = axis.squaredNorm();
    if (along > 0) {
      if (along * along > reach * reach * squared_axis) return Nearness::beyond;
      if (along * along > least * least * squared_axis) parted = true;
    }
    if (i > 0 && (best - along <= 1e-13 * best || simplex.holds(p.w))) break;
    simplex.add(p);
    if (simplex.reduce()) break;
    const Eigen::Vector3d closest = simplex.closest();
    const double squared = closest.squaredNorm();
    // A point of the difference lies nearer than the reach: it cannot be beyond.
    if (parted && squared < reach * reach) return Nearness::near;
    if (squared <= touching_clearance(p) * touching_clearance(p) || !(squared < best)) break;
    best = squared;
    axis = closest;
  }
  return parted ? Nearness::near : Nearness::touching;
}

}  // namespace mmgrasp::detail
