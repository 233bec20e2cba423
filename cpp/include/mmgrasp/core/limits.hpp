#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <string_view>

#include "mmgrasp/core/export.hpp"

namespace mmgrasp {

/// No coordinate, size or distance [m] and no joint value [rad, m] that enters the library is larger: squares and
/// products of lengths stay far from overflow, and coordinates are known to 1e-10 m. Checked where bodies, poses, maps
/// and configurations come in, never in the queries themselves.
inline constexpr double kLargestLength = 1e6;
/// No dimension of a shape and no edge of a cell [m] is smaller.
inline constexpr double kSmallestLength = 1e-9;
/// No other number is larger: moduli [Pa], costs, weights, what a solver is given. Its square and cube are finite.
inline constexpr double kLargestNumber = 1e15;
/// No number of iterations, samples or other things to count is larger: one more, or a count beside it, still fits an
/// int.
inline constexpr std::int64_t kLargestCount = 2'000'000'000;

/// Throws InvalidInput naming `field`, the rule and `unit` unless value lies in (0, largest], in [0, largest], or
/// within `largest` of 0.
MMGRASP_EXPORT void require_positive(double value, std::string_view field, std::string_view unit = "",
                                     double largest = kLargestLength);
MMGRASP_EXPORT void require_not_negative(double value, std::string_view field, std::string_view unit = "",
                                         double largest = kLargestLength);
MMGRASP_EXPORT void require_number(double value, std::string_view field, std::string_view unit = "",
                                   double largest = kLargestLength);
/// require_number() of each; the message names the first that is none as field[i].
MMGRASP_EXPORT void require_numbers(const Eigen::Ref<const Eigen::VectorXd>& values, std::string_view field,
                                    std::string_view unit = "", double largest = kLargestLength);

/// Throws InvalidInput naming `field` unless the value lies in [kSmallestLength, kLargestLength].
MMGRASP_EXPORT void require_length(double value, const std::string& field);
/// Throws InvalidInput naming `field` unless the value lies within kLargestLength of 0.
MMGRASP_EXPORT void require_coordinate(double value, const std::string& field);
/// Throws InvalidInput naming `field` unless low <= value <= high; the unit is told with the rule.
MMGRASP_EXPORT void require_within(double value, double low, double high, const std::string& field,
                                   const std::string& unit);
/// Throws InvalidInput naming `field` unless least <= value <= most.
MMGRASP_EXPORT void require_count(std::int64_t value, std::string_view field, std::int64_t least = 1,
                                  std::int64_t most = kLargestCount);
/// Throws InvalidInput naming `field` unless every coordinate lies within kLargestLength of 0.
MMGRASP_EXPORT void require_position(const Eigen::Vector3d& position, const std::string& field);
/// The same of many points, as columns; the message names the first that does not.
MMGRASP_EXPORT void require_positions(const Eigen::Ref<const Eigen::Matrix3Xd>& positions, const std::string& field);

}  // namespace mmgrasp
