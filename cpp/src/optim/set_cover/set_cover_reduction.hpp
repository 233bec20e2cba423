#pragma once

#include <vector>

#include "mmgrasp/core/detail/bits.hpp"
#include "mmgrasp/optim/set_cover.hpp"

namespace mmgrasp::detail {

/// What remains of a set cover problem once nothing more follows by logic alone.
struct ReducedCover {
  std::vector<int> forced;    ///< Sets that some cheapest cover contains.
  std::vector<int> sets;      ///< Sets still to be decided, ascending.
  std::vector<int> elements;  ///< Elements not covered by `forced`, without those implied by others, ascending.
};

/// Repeats until nothing changes: take the only set of an element; drop a set whose elements another set covers for no
/// more cost; drop an element that is covered whenever another one is. Every element must lie in some set.
ReducedCover reduce_set_cover(const SetCoverProblem& problem);

}  // namespace mmgrasp::detail
