#pragma once

#include <vector>

#include "mmgrasp/optim/set_cover.hpp"

namespace mmgrasp::detail {

/// Covers of at most `size` sets that cost no more than `cost` (and 1e-9 of it), in the order a depth-first search
/// meets them, up to `count` of them; the search also ends after some hundred thousand steps.
std::vector<std::vector<int>> equal_covers(const SetCoverProblem& problem, double cost, std::size_t size,
                                           std::size_t count);

}  // namespace mmgrasp::detail
