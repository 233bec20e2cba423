#pragma once

#include "mmgrasp/grasp/hand.hpp"

namespace mmgrasp::detail {

/// The hand seen along its approach at an opening: half lengths from its middle [m]. Each finger lies between `inner`
/// and `outer` along the closing axis and within `side` across it, the palm within `palm` and `palm_side`.
struct HandOutline {
  HandOutline(const Hand& hand, double opening);  ///< Throws InvalidInput outside [0, max_opening].
  double inner, outer, side, palm, palm_side;
};

}  // namespace mmgrasp::detail
