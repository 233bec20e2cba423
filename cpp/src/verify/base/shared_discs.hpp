#pragma once

#include <vector>

#include "mmgrasp/core/monitor.hpp"
#include "verify/base/floor.hpp"
#include "verify/base/smallest_cover.hpp"

namespace mmgrasp::verify::detail {

/// A disc of radius r lies in a region when no place outside of the region comes nearer to its middle than this much
/// less than r [m]: numbers have no more digits. So a disc that fits exactly counts, for planners as for this check.
constexpr double kRadiusSlack = 1e-9;

/// Sets of regions whose shared floor holds a disc of some radius.
struct SharedDiscs {
  std::vector<RegionSet> certain;   ///< A place of such a disc was found for each.
  std::vector<RegionSet> possible;  ///< Every set that shares a disc is part of one of these.
  bool cut = false;                 ///< The search ended at a limit, or was stopped: `possible` is larger for it.
};

/// Searches all floor for discs of this radius (>= 0). Discs of at most half a cell fit into single cells, so that
/// cells are the answer. Otherwise floor squares are halved until few edges of discs' places cross one; where several
/// regions share places at all, they share a crossing of two such edges, and these are tried one by one. `certain` and
/// `possible` then differ by discs alone that are too small by less than 1e-8 m, unless the search was cut.
SharedDiscs shared_discs(const Floor& floor, double radius, const Monitor& monitor);

}  // namespace mmgrasp::verify::detail
