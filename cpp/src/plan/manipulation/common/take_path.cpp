// take_path: how every planner over many grasps hands in what it found.
#include <utility>

#include "plan/manipulation/common/manipulation_planner.hpp"

namespace mmgrasp::detail {

void take_path(const ManipulationInput& input, TransferPath carry, ManipulationResult& result) {
  if (result.path && carry.cost >= result.cost) return;
  result.grasp_index = carry.grasp;
  result.cost = carry.cost;
  result.improvements.push_back({input.clock.seconds(), carry.cost, carry.grasp, carry.path});
  result.path = std::move(carry.path);
  if (input.improved) input.improved(result.improvements.back());
}

}  // namespace mmgrasp::detail
