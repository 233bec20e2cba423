#pragma once

#include "plan/manipulation/common/manipulation_planner.hpp"

namespace mmgrasp::detail {

/// A first path, told before a planner of carries begins; without a path: as TransferPath is made. Grasps come one by
/// one in the order drawn by the seed; each with ends at both sides gets its straight edges and a short RRT-Connect,
/// and from round to round (ManipulationOptions::first_grasps) those before it longer ones. All budgets are counts.
/// Does nothing when all ends shall be found first.
TransferPath find_first_transfer(const ManipulationInput& input, ManipulationResult& result);

}  // namespace mmgrasp::detail
