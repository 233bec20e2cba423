#include "mmgrasp/geometry/detail/shape_rays.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::Vector3d;

/// Where the line is inside a convex body; empty when enter > leave.
struct Span {
  double enter = -kInfinity, leave = kInfinity;
};

double first_of(const Span& span) {
  if (span.enter > span.leave) return kInfinity;
  return span.enter > 0 ? span.enter : span.leave > 0 && span.leave < kInfinity ? span.leave : kInfinity;
}

void clip_slab(Span& span, double origin, double direction, double half) {
  if (direction == 0) {
    if (std::abs(origin) > half) span = {kInfinity, -kInfinity};
    return;
  }
  double a = (-half - origin) / direction, b = (half - origin) / direction;
  if (a > b) std::swap(a, b);
  span.enter = std::max(span.enter, a);
  span.leave = std::min(span.leave, b);
}

/// a t^2 + 2 b t + c <= 0
Span clip_quadratic(double a, double b, double c) {
  if (a <= 0) return c <= 0 ? Span{} : Span{kInfinity, -kInfinity};
  const double root = b * b - a * c;
  if (root < 0) return {kInfinity, -kInfinity};
  const double s = std::sqrt(root);
  return {(-b - s) / a, (-b + s) / a};
}

Span sphere_span(double radius, const Vector3d& o, const Vector3d& d) {
  return clip_quadratic(d.squaredNorm(), o.dot(d), o.squaredNorm() - radius * radius);
}

Span tube(double radius, double length, const Vector3d& o, const Vector3d& d) {
  Span span = clip_quadratic(d.head<2>().squaredNorm(), o.head<2>().dot(d.head<2>()),
                             o.head<2>().squaredNorm() - radius * radius);
  clip_slab(span, o.z(), d.z(), length / 2);
  return span;
}

}  // namespace

double first_hit(const Shape& shape, const Vector3d& o, const Vector3d& d) {
  if (const auto* s = std::get_if<Box>(&shape)) {
    Span span;
    for (int k = 0; k < 3; ++k) clip_slab(span, o[k], d[k], s->size[k] / 2);
    return first_of(span);
  }
  if (const auto* s = std::get_if<Sphere>(&shape)) return first_of(sphere_span(s->radius, o, d));
  if (const auto* s = std::get_if<Cylinder>(&shape)) return first_of(tube(s->radius, s->length, o, d));
  if (const auto* s = std::get_if<Capsule>(&shape)) {
    // A union of three convex bodies that is convex itself: it is entered where the first is and left where the last
    // is.
    Span all{kInfinity, -kInfinity};
    const auto join = [&](const Span& part) {
      if (part.enter > part.leave) return;
      all.enter = std::min(all.enter, part.enter);
      all.leave = std::max(all.leave, part.leave);
    };
    const Vector3d cap(0, 0, s->length / 2);
    join(sphere_span(s->radius, o - cap, d));
    join(sphere_span(s->radius, o + cap, d));
    if (s->length > 0) join(tube(s->radius, s->length, o, d));
    return first_of(all);
  }
  if (const auto* s = std::get_if<Plane>(&shape)) {
    const double speed = s->normal.dot(d);
    const double t = speed != 0 ? (s->offset - s->normal.dot(o)) / speed : kInfinity;
    return t > 0 ? t : kInfinity;
  }
  return kInfinity;
}

}  // namespace mmgrasp::detail
