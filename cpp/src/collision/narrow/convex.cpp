#include "collision/narrow/convex.hpp"

#if defined(__SSE2__)
#include <emmintrin.h>
#endif

#include "collision/narrow/difference.hpp"
#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {

namespace {

constexpr int kMaxIterations = 128;

int farthest_scalar(const double* x, int count, const Eigen::Vector3d& d) {
  const double *y = x + count, *z = y + count;
  int best = 0;
  double top = -kInfinity;
  for (int i = 0; i < count; ++i) {
    const double value = x[i] * d[0] + y[i] * d[1] + z[i] * d[2];
    if (value > top) top = value, best = i;
  }
  return best;
}

#if defined(__SSE2__)
// Two points a step; indices ride along as doubles. Plain SSE2, so every x86-64 machine has it.
int farthest_sse2(const double* x, int count, const Eigen::Vector3d& d) {
  const double *y = x + count, *z = y + count;
  const __m128d dx = _mm_set1_pd(d[0]), dy = _mm_set1_pd(d[1]), dz = _mm_set1_pd(d[2]);
  __m128d top = _mm_set1_pd(-kInfinity), best = _mm_setzero_pd();
  __m128d index = _mm_set_pd(1, 0);
  const __m128d two = _mm_set1_pd(2);
  for (int i = 0; i < count; i += 2) {
    const __m128d value =
        _mm_add_pd(_mm_add_pd(_mm_mul_pd(_mm_loadu_pd(x + i), dx), _mm_mul_pd(_mm_loadu_pd(y + i), dy)),
                   _mm_mul_pd(_mm_loadu_pd(z + i), dz));
    const __m128d more = _mm_cmpgt_pd(value, top);
    top = _mm_max_pd(value, top);
    best = _mm_or_pd(_mm_and_pd(more, index), _mm_andnot_pd(more, best));
    index = _mm_add_pd(index, two);
  }
  double tops[2], bests[2];
  _mm_storeu_pd(tops, top);
  _mm_storeu_pd(bests, best);
  return static_cast<int>(tops[1] > tops[0] ? bests[1] : bests[0]);
}
#endif

int farthest(const double* points, int count, const Eigen::Vector3d& d) {
#if defined(__SSE2__)
  if (count % 2 == 0) return farthest_sse2(points, count, d);
#endif
  return farthest_scalar(points, count, d);
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
      const int i = farthest(points, count, d);
      return {points[i], points[count + i], points[2 * count + i]};
    }
  }
  return centre;
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
