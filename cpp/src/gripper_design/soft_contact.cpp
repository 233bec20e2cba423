#include "mmgrasp/gripper_design/soft_contact.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"

namespace mmgrasp {
namespace {

constexpr int kSlices = 512;  // across half a contact

/// Mean distance of the points (x, y), |y| <= half, from the origin.
double mean_distance(double x, double half) {
  return (std::hypot(x, half) + x * x / half * std::asinh(half / x)) / 2;
}

}  // namespace

ContactArea flat_contact(double length, double width) {
  require_positive(length, "length", "m");
  require_positive(width, "width", "m");
  const double p = length / 2, q = width / 2, d = std::hypot(p, q);
  return {length, width, d / 3 + p * p / (6 * q) * std::asinh(q / p) + q * q / (6 * p) * std::asinh(p / q)};
}

ContactArea line_contact(double force, double wall_radius, double length, double pad_width, double modulus,
                         double pad_radius) {
  require_positive(force, "force", "N");
  require_positive(wall_radius, "wall_radius", "m");
  require_positive(length, "length", "m");
  require_positive(pad_width, "pad_width", "m");
  require_positive(modulus, "modulus", "Pa", kLargestNumber);
  require(pad_radius >= wall_radius, "pad_radius", pad_radius, "must be at least the wall's radius [m]");
  const double curvature = 1 / wall_radius - 1 / pad_radius;
  const double hertz = curvature > 0 ? std::sqrt(4 * force / (detail::kPi * length * modulus * curvature)) : pad_width;
  const double half = std::min(hertz, pad_width / 2);
  // x = half sin(turn): the pressure sqrt(1 - (x / half)^2) and dx give cos^2.
  double sum = 0, weight = 0;
  for (int i = 0; i < kSlices; ++i) {
    const double turn = detail::kPi / 2 * (i + 0.5) / kSlices, share = std::cos(turn) * std::cos(turn);
    sum += share * mean_distance(half * std::sin(turn), length / 2);
    weight += share;
  }
  return {length, 2 * half, sum / weight};
}

double soft_finger_torque(double normal, double friction, double torsion_radius, double tangential) {
  require_not_negative(normal, "normal");
  require_not_negative(friction, "friction");
  require_not_negative(torsion_radius, "torsion_radius");
  require_not_negative(tangential, "tangential");
  const double most = friction * normal;
  return torsion_radius * std::sqrt(std::max(0.0, (most - tangential) * (most + tangential)));
}

}  // namespace mmgrasp
