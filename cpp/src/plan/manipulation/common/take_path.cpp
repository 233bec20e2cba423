// take_path(): how every planner over many grasps reports a better path.
#include <algorithm>
#include <utility>
#include <vector>

#include "plan/manipulation/common/manipulation_planner.hpp"

namespace mmgrasp::detail {

namespace {

void report_stage(const Improvement& better, std::vector<StageReport>& stages) {
  auto own = std::find_if(stages.begin(), stages.end(), [&](const StageReport& r) { return r.stage == better.stage; });
  if (own == stages.end()) own = stages.insert(stages.end(), {better.stage, 0, better.seconds, 0, 0});
  ++own->improvements;
  own->last_seconds = better.seconds;
  own->cost = better.cost;
}

}  // namespace

void take_path(const ManipulationInput& input, TransferPath path, ManipulationResult& result) {
  if (result.path && path.cost >= result.cost) return;
  result.grasp_index = path.grasp;
  result.cost = path.cost;
  result.improvements.push_back({input.clock.seconds(), path.cost, path.grasp, path.path, path.stage});
  report_stage(result.improvements.back(), result.stats.stages);
  result.path = std::move(path.path);
  if (input.on_improvement) input.on_improvement(result.improvements.back());
}

}  // namespace mmgrasp::detail
