#pragma once

#include "structure/frame/beam_element.hpp"

namespace mmgrasp::detail {

/// Where a curve over [0, 1] is farthest from the origin.
struct LongestPoint {
  double squared = 0;  ///< Square of the distance.
  double at = 0;       ///< Where on the curve, in [0, 1].
};

/// Raises `best` to the curve's largest squared distance when that is more than `best` has, within 1e-9 of it. A
/// polynomial in Bernstein's basis lies between its least and its largest coefficient: halves of the curve that cannot
/// hold more than the best value are dropped, so nothing is missed. Returns true when `best` was raised.
bool raise_to_longest(const Curve& curve, LongestPoint& best);

}  // namespace mmgrasp::detail
