#include "plan/manipulation/common/finish_path.hpp"

#include <utility>

#include "plan/motion/redundant_waypoints.hpp"

namespace mmgrasp::detail {

void finish_path(const ManipulationInput& input, ManipulationResult& result) {
  if (!result.path) return;
  const int grasp = result.grasp_index;
  JointPath path = *result.path;
  remove_redundant_waypoints(path.waypoints, [&](const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
    return input.checks.path_edge_is_free(grasp, a, b);
  });
  if (path.waypoints.size() == result.path->waypoints.size()) return;
  const double cost = input.metric.length(path.waypoints) + input.problem.grasps[grasp].cost;
  if (cost < result.cost) return take_path(input, {grasp, cost, std::move(path), PlanStage::shortening}, result);
  result.improvements.back().path = path;
  result.path = std::move(path);
}

}  // namespace mmgrasp::detail
