#pragma once

#include <string>

#include "mmgrasp/task/ids.hpp"
#include "mmgrasp/task/problem.hpp"

namespace mmgrasp::detail {

/// What the hand, open to take the part, touches in the scene with all parts, and at how many of the part's grasps,
/// most first:
/// "'counter' (180 of 200 grasps), 'tray A' (120)". Empty when nothing is touched.
std::string hand_obstacles(const PartSupplyProblem& problem, PartRef part);

}  // namespace mmgrasp::detail
