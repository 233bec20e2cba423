#pragma once

#include "plan/manipulation/common/carry_planner.hpp"

namespace mmgrasp::detail {

/// Shortens a free path as plan_motion does, its grasp in hand; the result takes what comes of it when that is free and
/// its cheapest. Not for platforms that turn and drive. Another `round`, other random corners.
void shorten_carry(const CarryInput& input, const Carry& carry, ManipulationResult& result, unsigned round = 0);

}  // namespace mmgrasp::detail
