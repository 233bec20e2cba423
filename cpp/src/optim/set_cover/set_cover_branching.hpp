#pragma once

#include <optional>
#include <vector>

#include "mmgrasp/optim/set_cover.hpp"

namespace mmgrasp::detail {

struct BranchAndBoundAnswer {
  std::optional<std::vector<int>> chosen;  ///< Counted again: it covers everything.
  double lower_bound = 0;                  ///< What rounding in the linear programmes cannot have lifted too far.
  bool proven = false;                     ///< `chosen` is optimal.
  bool none_cheaper = false;               ///< No cover is cheaper than the one known before.
};

/// CBC on the whole problem (costs must be given), no gap allowed, given the cost of a cover known already. Calls wait
/// for each other.
BranchAndBoundAnswer branch_and_bound(const SetCoverProblem& problem, double known_cost, double time_limit,
                                      const Monitor& monitor);

}  // namespace mmgrasp::detail
