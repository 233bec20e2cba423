#include "mapping/shape_rays.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace mmgrasp::detail {
namespace {

using Eigen::Vector3d;
constexpr double kNever = std::numeric_limits<double>::infinity();

/// Where the line is inside a convex body; empty when enter > leave.
struct Span {
  double enter = -kNever, leave = kNever;
};

double first_of(const Span& span) {
  if (span.enter > span.leave) return kNever;
  return span.enter > 0 ? span.enter : span.leave > 0 && span.leave < kNever ? span.leave : kNever;
}

void clip_slab(Span& span, double origin, double direction, double half) {
  if (direction == 0) {
    if (std::abs(origin) > half) span = {kNever, -kNever};
    return;
  }
  double a = (-half - origin) / direction, b = (half - origin) / direction;
  if (a > b) std::swap(a, b);
  span.enter = std::max(span.enter, a);
  span.leave = std::min(span.leave, b);
}

/// a t^2 + 2 b t + c <= 0
Span clip_quadratic(double a, double b, double c) {
  if (a <= 0) return c <= 0 ? Span{} : Span{kNever, -kNever};
  const double root = b * b - a * c;
  if (root < 0) return {kNever, -kNever};
  const double s = std::sqrt(root);
  return {(-b - s) / a, (-b + s) / a};
}

Span ball(double radius, const Vector3d& o, const Vector3d& d) {
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
  if (const auto* s = std::get_if<Sphere>(&shape)) return first_of(ball(s->radius, o, d));
  if (const auto* s = std::get_if<Cylinder>(&shape)) return first_of(tube(s->radius, s->length, o, d));
  if (const auto* s = std::get_if<Capsule>(&shape)) {
    // A union of three convex bodies that is convex itself: it is entered where the first is and left where the last
    // is.
    Span all{kNever, -kNever};
    const auto join = [&](const Span& part) {
      if (part.enter > part.leave) return;
      all.enter = std::min(all.enter, part.enter);
      all.leave = std::max(all.leave, part.leave);
    };
    const Vector3d cap(0, 0, s->length / 2);
    join(ball(s->radius, o - cap, d));
    join(ball(s->radius, o + cap, d));
    if (s->length > 0) join(tube(s->radius, s->length, o, d));
    return first_of(all);
  }
  if (const auto* s = std::get_if<Plane>(&shape)) {
    const double speed = s->normal.dot(d);
    const double t = speed != 0 ? (s->offset - s->normal.dot(o)) / speed : kNever;
    return t > 0 ? t : kNever;
  }
  return kNever;
}

}  // namespace mmgrasp::detail
