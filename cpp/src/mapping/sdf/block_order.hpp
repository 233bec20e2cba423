#pragma once

// Points and rays in any order miss the cache; block by block they do not.

#include <vector>

namespace mmgrasp::detail {

/// Indices into `block`, a list of block numbers below `blocks` or negative ones, in the order of these numbers and
/// negative ones last; ties stay in order.
std::vector<int> block_order(const std::vector<int>& block, int blocks);

}  // namespace mmgrasp::detail
