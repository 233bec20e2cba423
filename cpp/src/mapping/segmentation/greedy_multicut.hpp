#pragma once

#include <vector>

#include "mmgrasp/core/export.hpp"

namespace mmgrasp::detail {

/// An edge of a signed graph: the two belong together when the weight is positive, apart when it is negative.
struct SignedEdge {
  int a = 0, b = 0;
  double weight = 0;
};

/// Parts a signed graph so that the weights within the parts are as large in sum as can be had by joining, again and
/// again, the two parts whose common edges have the largest sum, while it is positive (greedy additive edge
/// contraction for the multicut problem: Keuper et al., ICCV 2015). Edges of one pair add up. Returns the part of each
/// node, numbered by its first node.
MMGRASP_EXPORT std::vector<int> greedy_multicut(int nodes, const std::vector<SignedEdge>& edges);

}  // namespace mmgrasp::detail
