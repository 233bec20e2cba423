// take_path(): how every planner over many grasps reports a better path.
#include <utility>

#include "plan/manipulation/common/manipulation_planner.hpp"

namespace mmgrasp::detail {

void take_path(const ManipulationInput& input, TransferPath path, ManipulationResult& result) {
  if (result.path && path.cost >= result.cost) return;
  result.grasp_index = path.grasp;
  result.cost = path.cost;
  result.improvements.push_back({input.clock.seconds(), path.cost, path.grasp, path.path});
  result.path = std::move(path.path);
  if (input.on_improvement) input.on_improvement(result.improvements.back());
}

}  // namespace mmgrasp::detail
