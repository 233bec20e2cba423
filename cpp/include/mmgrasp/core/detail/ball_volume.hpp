#pragma once

#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {

/// Volume of the unit ball in `dimension` dimensions.
inline double unit_ball_volume(int dimension) {
  return std::pow(kPi, 0.5 * dimension) / std::tgamma(0.5 * dimension + 1);
}

}  // namespace mmgrasp::detail
