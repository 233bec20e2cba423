#include "collision/narrow/convex.hpp"

#include "collision/kernels/kernels.hpp"
#include "collision/narrow/difference.hpp"
#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {

namespace {

constexpr int kMaxIterations = 128;

int farthest_corner(const double* x, const Eigen::Vector3d& d) {
  int best = 0;
  double top = -kInfinity;
  for (int i = 0; i < 3; ++i) {
    const double value = x[i] * d[0] + x[3 + i] * d[1] + x[6 + i] * d[2];
    if (value > top) top = value, best = i;
  }
  return best;
}

inline double with_sign(double magnitude, double sign) {
  return sign >= 0 ? magnitude : -magnitude;
}

}  // namespace

Eigen::Vector3d Convex::support(const Eigen::Vector3d& d) const {
  switch (kind) {
    case ConvexKind::point:
      return centre;
    case ConvexKind::segment:
      return {centre[0], centre[1], centre[2] + with_sign(half[2], d[2])};
    case ConvexKind::box:
      return {centre[0] + with_sign(half[0], d[0]), centre[1] + with_sign(half[1], d[1]),
              centre[2] + with_sign(half[2], d[2])};
    case ConvexKind::cylinder: {
      const double length = std::sqrt(d[0] * d[0] + d[1] * d[1]);
      const double f = length > 0 ? half[0] / length : 0;
      return {centre[0] + f * d[0], centre[1] + f * d[1], centre[2] + with_sign(half[2], d[2])};
    }
    case ConvexKind::hull: {
      const int i = count == 3 ? farthest_corner(points, d) : kernels().farthest(points, count, d.data());
      return {points[i], points[count + i], points[2 * count + i]};
    }
  }
  return centre;
}

Eigen::Vector3d Convex::support_roughly(const Eigen::Vector3d& d) const {
  if (rough == nullptr) return support(d);
  const Eigen::Vector3f along = d.cast<float>();
  const int i = kernels().nearly_farthest(rough, count, along.data());
  return {points[i], points[count + i], points[2 * count + i]};
}

bool convex_collide(const Convex& a, const Convex& b, const Rigid& b_in_a, double margin, Eigen::Vector3d& axis) {
  const double reach = a.radius + b.radius + margin;
  if (axis.squaredNorm() < 1e-20) axis = a.centre - b_in_a * b.centre;
  if (axis.squaredNorm() < 1e-20) axis = Eigen::Vector3d::UnitX();
  Simplex simplex;
  double best = kInfinity;  // squared length of the simplex's closest point
  for (int i = 0; i < kMaxIterations; ++i) {
    const SimplexPoint p = difference(a, b, b_in_a, axis);
    const double along = axis.dot(p.w);
    // The whole difference lies beyond the plane through w: apart by along / |axis|.
    if (along > 0 && along * along > reach * reach * axis.squaredNorm()) return false;
    if (i > 0 && (best - along <= 1e-13 * best || simplex.holds(p.w))) break;  // converged: |axis| is the distance
    simplex.add(p);
    if (simplex.reduce()) {
      if (along > 0) break;  // apart for certain: only rounding put the origin inside a flat tetrahedron
      return true;
    }
    const Eigen::Vector3d closest = simplex.closest();
    const double squared = closest.squaredNorm();
    if (squared <= reach * reach) return true;
    if (squared < 1e-16 && squared <= touching_clearance(p) * touching_clearance(p)) return true;
    if (!(squared < best)) break;  // rounding stops the descent
    best = squared;
    axis = closest;
  }
  return best <= reach * reach;
}

}  // namespace mmgrasp::detail
