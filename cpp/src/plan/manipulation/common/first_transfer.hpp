#pragma once

#include "plan/manipulation/common/manipulation_planner.hpp"

namespace mmgrasp::detail {

/// Finds and reports a first path before a planner over many grasps begins; a default TransferPath when there is none.
/// Grasps are tried one by one in the order drawn by the seed: straight edges, then a short RRT-Connect for each grasp
/// with arm configurations at both ends, and in later rounds (ManipulationOptions::first_grasps) longer ones. All
/// budgets are counts. Does nothing when all ends shall be found first.
TransferPath find_first_transfer(const ManipulationInput& input, ManipulationResult& result);

}  // namespace mmgrasp::detail
