#pragma once

#include "mmgrasp/core/detail/numbers.hpp"
#include "plan/manipulation/rrt_star_mg/tuning.hpp"

namespace mmgrasp::detail {

/// The best path known so far (c_i in P2's Algorithm 5.13): the bound for all that samples, grows and connects.
struct Incumbent {
  double cost = kInfinity;
  int grasp = -1;  ///< Its grasp once the path runs through that grasp's trees; -1 before.

  bool in_trees() const { return grasp >= 0; }
  /// What a path must cost less than to count as better.
  double cost_to_beat() const { return cost * (1 - kLeastImprovement); }
};

}  // namespace mmgrasp::detail
