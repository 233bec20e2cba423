#pragma once

#include "plan/manipulation/common/manipulation_planner.hpp"

namespace mmgrasp::detail {

/// Shortens a free path as plan_motion does, its grasp in hand; the result takes what comes of it when that is free and
/// its cheapest. Not for platforms that turn and drive. Another `round`, other random corners.
void shorten_transfer(const ManipulationInput& input, const TransferPath& carry, ManipulationResult& result,
                      unsigned round = 0);

}  // namespace mmgrasp::detail
