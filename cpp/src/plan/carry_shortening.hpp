#pragma once

#include "plan/carry_planner.hpp"

namespace mmgrasp::detail {

/// Shortens the result's path as plan_motion does, its grasp in hand, and takes what is shorter and free. Not for
/// platforms that turn and drive.
void shorten_carry(const CarryInput& input, ManipulationResult& result);

}  // namespace mmgrasp::detail
