#pragma once

#include "mmgrasp/task/part_supply.hpp"

namespace mmgrasp {

/// What to say about a tray whose region is empty or too small for the uncertainty. A move that `earlier` obstructions
/// advise for this tray is repeated.
Obstruction explain_region(const PartSupplyProblem& problem, const ReachDatabase& database,
                           BasePoseEvaluator& evaluator, const BaseGrid& grid, int tray, const BaseRegion& region,
                           const std::vector<Obstruction>& earlier = {});

/// Largest disc in any layer of the region [m]; 0 when it is empty.
double largest_radius(const BaseGrid& grid, const BaseRegion& region);

}  // namespace mmgrasp
