#include "mmgrasp/grasp/line_grasp.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"

namespace mmgrasp {
namespace {

double standard_density(double z) {
  return std::exp(-z * z / 2) / std::sqrt(detail::kTwoPi);
}

double standard_distribution(double z) {
  return 0.5 * std::erfc(-z / std::sqrt(2.0));
}

}  // namespace

void LineGrasp::check() const {
  require_positive(max_opening, "max_opening", "m");
  require(width > 0 && width < max_opening, "width", width, "must be positive and below max_opening [m]");
}

double LineGrasp::success(double opening, double position, double object) const {
  check();
  require(opening >= 0 && opening <= max_opening, "opening", opening, "must be in [0, max_opening] [m]");
  require_coordinate(position, "position");
  require_coordinate(object, "object");
  const double off = std::abs(position - object);
  return off < (opening - width) / 2 ? 1 - off / ((max_opening - width) / 2) : 0;
}

double LineGrasp::probability(double opening, double position, double mean, double sigma) const {
  check();
  require(opening >= 0 && opening <= max_opening, "opening", opening, "must be in [0, max_opening] [m]");
  require_number(position, "position", "m");
  require(std::isfinite(mean), "position", position, "must be finite [m]");
  require_positive(sigma, "sigma", "m");
  const double room = (opening - width) / 2, most = (max_opening - width) / 2;
  if (room <= 0) return 0;
  // Each side is the integral of a straight line times the normal density.
  const auto side = [&](double begin, double end, double slope) {
    const double a = (begin - mean) / sigma, b = (end - mean) / sigma;
    const double mass = standard_distribution(b) - standard_distribution(a);
    const double moment = mean * mass - sigma * (standard_density(b) - standard_density(a));
    return mass + slope / most * (moment - position * mass);
  };
  return std::clamp(side(position - room, position, 1) + side(position, position + room, -1), 0.0, 1.0);
}

}  // namespace mmgrasp
