#pragma once

#include "plan/manipulation/common/manipulation_planner.hpp"

namespace mmgrasp::detail {

/// PRM*-MG (P2 chapter 4, Algorithm 4.3 with its errata) over the caller's roadmap or one of its own. All variants
/// return the cheapest free path over this roadmap.
bool run_prm_star_mg(ManipulationInput& input, ManipulationResult& result);

}  // namespace mmgrasp::detail
