#pragma once

#include "mmgrasp/core/export.hpp"
#include "plan/manipulation/common/manipulation_planner.hpp"
#include "plan/manipulation/rrt_star_mg/tuning.hpp"

namespace mmgrasp::detail {

/// RRT*-MG (P2 chapter 5, Algorithm 5.13 with its errata), after a first path by find_first_transfer(). Never says that
/// there is no path: trees can always grow on. One thread, so that the samples alone decide what is found.
MMGRASP_EXPORT bool run_rrt_star_mg(ManipulationInput& input, ManipulationResult& result,
                                    const RrtStarMgTuning& tuning);

}  // namespace mmgrasp::detail
