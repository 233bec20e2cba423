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

Nearness convex_nearness(const Convex& a, const Convex& b, const Rigid& b_in_a, const Closing& closing, double touch,
                         Eigen::Vector3d& axis, double& share) {
  const double grown = a.radius + b.radius + a.rough_error + b.rough_error;
  const double least = touch + grown;  // of the cores
  if (!(axis.squaredNorm() > 1e-20)) axis = a.centre - b_in_a * b.centre;
  if (!(axis.squaredNorm() > 1e-20)) axis = Eigen::Vector3d::UnitX();
  Simplex simplex;
  double best = kInfinity;  // squared length of the simplex's closest point
  double room = 0;          // of the plane that parted them last
  Eigen::Vector3d normal = axis;
  const auto end = [&] {
    if (room <= 0) return Nearness::touching;
    share = closing.share_along(normal, room);
    return Nearness::near;
  };
  for (int i = 0; i < kMaxIterations; ++i) {
    SimplexPoint p;
    p.on_a = a.support_roughly(-axis);
    p.on_b = b_in_a * b.support_roughly(b_in_a.R.transpose() * axis);
    p.w = p.on_a - p.on_b;
    const double along = axis.dot(p.w), least_along = least * axis.norm();
    if (along > least_along) {
      room = along - least_along;
      normal = axis;
      if (room > closing.along(axis)) {
        share = 1;
        return Nearness::beyond;
      }
    }
    if (i > 0 && (best - along <= 1e-13 * best || simplex.holds(p.w))) break;
    simplex.add(p);
    if (simplex.reduce()) break;
    const Eigen::Vector3d closest = simplex.closest();
    const double squared = closest.squaredNorm();
    // A point of the difference lies nearer than that: little hope is left.
    if (room > 0 && squared < least * std::sqrt(squared) + closing.along(closest)) return end();
    if (squared <= touching_clearance(p) * touching_clearance(p) || !(squared < best)) break;
    best = squared;
    axis = closest;
  }
  return end();
}

}  // namespace mmgrasp::detail
