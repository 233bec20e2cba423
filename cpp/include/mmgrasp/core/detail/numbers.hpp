#pragma once

#include <cmath>
#include <limits>

namespace mmgrasp::detail {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kTwoPi = 2 * kPi;
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The shortest turn [rad] that has the same effect as `turn`: in [-pi, pi], either end for half turns.
inline double shortest_turn(double turn) {
  return std::remainder(turn, kTwoPi);
}

/// The whole turns [rad] nearest to `turn`; subtracted from it, the shortest turn is left.
inline double whole_turns(double turn) {
  return kTwoPi * std::round(turn / kTwoPi);
}

}  // namespace mmgrasp::detail
