#include "mmgrasp/gripper_design/soft_contact.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"

namespace mmgrasp {
namespace {

constexpr int kSlices = 512;  // across half a contact

void require_positive(const char* name, double value, const char* rule) {
  require(std::isfinite(value) && value > 0, name, value, rule);
}

void require_no_less_than_zero(const char* name, double value) {
  require(std::isfinite(value) && value >= 0, name, value, "must be at least 0 and finite");
}

/// Mean distance of the points (x, y), |y| <= half, from the origin.
double mean_distance(double x, double half) {
  return (std::hypot(x, half) + x * x / half * std::asinh(half / x)) / 2;
}

}  // namespace

ContactArea flat_contact(double length, double width) {
  require_positive("length", length, "must be a positive length [m]");
  require_positive("width", width, "must be a positive length [m]");
  const double p = length / 2, q = width / 2, d = std::hypot(p, q);
  return {length, width, d / 3 + p * p / (6 * q) * std::asinh(q / p) + q * q / (6 * p) * std::asinh(p / q)};
}

ContactArea line_contact(double force, double wall_radius, double length, double pad_width, double modulus,
                         double pad_radius) {
  require_positive("force", force, "must be a positive force [N]");
  require_positive("wall_radius", wall_radius, "must be a positive length [m]");
  require_positive("length", length, "must be a positive length [m]");
  require_positive("pad_width", pad_width, "must be a positive length [m]");
  require_positive("modulus", modulus, "must be a positive modulus [Pa]");
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
  require_no_less_than_zero("normal", normal);
  require_no_less_than_zero("friction", friction);
  require_no_less_than_zero("torsion_radius", torsion_radius);
  require_no_less_than_zero("tangential", tangential);
  const double most = friction * normal;
  return torsion_radius * std::sqrt(std::max(0.0, (most - tangential) * (most + tangential)));
}

}  // namespace mmgrasp
