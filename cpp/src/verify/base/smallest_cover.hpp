#pragma once

#include <set>
#include <vector>

namespace mmgrasp::verify::detail {

/// Indices of regions (trays).
using RegionSet = std::set<int>;

/// Adds a set unless one in the list holds it; drops those that it holds.
void add_maximal(std::vector<RegionSet>& sets, const RegionSet& set);

/// How many sets it takes to cover something: at least `lower`, and `upper` are enough. Both -1: no number of them
/// does.
struct CoverBounds {
  int lower = -1, upper = -1;
};

/// Least number of sets that cover all of `wanted`, by CBC; the bounds differ where its search ended at a limit.
CoverBounds smallest_cover(const std::vector<RegionSet>& sets, const RegionSet& wanted);

}  // namespace mmgrasp::verify::detail
