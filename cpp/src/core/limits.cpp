#include "mmgrasp/core/limits.hpp"

#include <cmath>
#include <cstdio>

#include "mmgrasp/core/error.hpp"

namespace mmgrasp {

static void refuse(double value, std::string_view field, const char* rule, double largest, std::string_view unit) {
  char bound[32];
  std::snprintf(bound, sizeof(bound), "%g", largest);
  std::string text = rule + std::string(bound);
  if (!unit.empty()) text += " [" + std::string(unit) + "]";
  require(false, std::string(field), value, text);
}

void require_positive(double value, std::string_view field, std::string_view unit, double largest) {
  if (!(value > 0 && value <= largest)) refuse(value, field, "must be positive and finite, at most ", largest, unit);
}

void require_not_negative(double value, std::string_view field, std::string_view unit, double largest) {
  if (!(value >= 0 && value <= largest)) refuse(value, field, "must be zero or positive, at most ", largest, unit);
}

void require_number(double value, std::string_view field, std::string_view unit, double largest) {
  if (!(std::abs(value) <= largest)) refuse(value, field, "must be finite and within ", largest, unit);
}

void require_numbers(const Eigen::Ref<const Eigen::VectorXd>& values, std::string_view field, std::string_view unit,
                     double largest) {
  for (Eigen::Index i = 0; i < values.size(); ++i) {
    if (std::abs(values[i]) <= largest) continue;
    require_number(values[i], std::string(field) + "[" + std::to_string(i) + "]", unit, largest);
  }
}

void require_length(double value, const std::string& field) {
  require(value >= kSmallestLength && value <= kLargestLength, field, value,
          "must be finite and > 0, in [1e-9, 1e6] m");
}

void require_coordinate(double value, const std::string& field) {
  require(std::abs(value) <= kLargestLength, field, value, "must be finite and within 1e6 m");
}

void require_within(double value, double low, double high, const std::string& field, const std::string& unit) {
  if (value >= low && value <= high) return;  // the message is put together for what is refused only
  char rule[64];
  std::snprintf(rule, sizeof(rule), "must be in [%g, %g]", low, high);
  require(false, field, value, rule + (unit.empty() ? "" : " " + unit));
}

void require_count(std::int64_t value, std::string_view field, std::int64_t least, std::int64_t most) {
  if (value >= least && value <= most) return;
  require(false, std::string(field), std::to_string(value),
          "must be in [" + std::to_string(least) + ", " + std::to_string(most) + "]");
}

void require_position(const Eigen::Vector3d& position, const std::string& field) {
  // Messages are put together for what is refused only.
  for (int k = 0; k < 3; ++k) {
    if (!(std::abs(position[k]) <= kLargestLength)) require_coordinate(position[k], field + "." + "xyz"[k]);
  }
}

void require_positions(const Eigen::Ref<const Eigen::Matrix3Xd>& positions, const std::string& field) {
  for (Eigen::Index i = 0; i < positions.cols(); ++i) {
    // As one comparison: clouds have millions of points.
    if (positions.col(i).cwiseAbs().maxCoeff() <= kLargestLength && !positions.col(i).hasNaN()) continue;
    require_position(positions.col(i), field + " " + std::to_string(i));
  }
}

}  // namespace mmgrasp
