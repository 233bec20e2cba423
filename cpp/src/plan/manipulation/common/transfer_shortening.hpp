#pragma once

#include "plan/manipulation/common/manipulation_planner.hpp"

namespace mmgrasp::detail {

/// Shortcuts a free path as plan_motion does, with the object in its grasp; the result takes the shorter path when that
/// is free and the cheapest so far. Not for steered bases. Another `round` tries other random shortcuts.
void shorten_transfer(const ManipulationInput& input, const TransferPath& path, ManipulationResult& result,
                      unsigned round = 0);

}  // namespace mmgrasp::detail
