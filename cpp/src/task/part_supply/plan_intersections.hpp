#pragma once

#include <vector>

#include "mmgrasp/task/base_sequence.hpp"

namespace mmgrasp::detail {

/// The intersections to be shown with a plan: every robust set of trays when there are not too many, else `candidates`.
/// Each stop's own is among them; Stop::intersection is set to its index.
Intersections plan_intersections(const BaseGrid& grid, const std::vector<BaseRegion>& regions, double min_radius,
                                 Intersections candidates, std::vector<Stop>& stops);

}  // namespace mmgrasp::detail
