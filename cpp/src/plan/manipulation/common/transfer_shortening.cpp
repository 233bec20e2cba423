#include "plan/manipulation/common/transfer_shortening.hpp"

#include <algorithm>
#include <utility>

#include "plan/motion/motion_edges.hpp"
#include "plan/motion/shortening.hpp"

namespace mmgrasp::detail {
namespace {

constexpr double kSecondResolution = 8;  // Resolution factor of a second try, when the first has cut a thin obstacle.
constexpr double kLeastGain = 1e-9;      // Smaller gains are rounding.

}  // namespace

void shorten_transfer(const ManipulationInput& input, const TransferPath& path, ManipulationResult& result,
                      unsigned round) {
  CollisionChecker checker = input.checks.whole(path.grasp);
  MotionOptions options;
  options.joint_step = input.options.edge.joint_step;
  options.workspace_step = input.options.edge.workspace_step;
  options.joint_weights = input.options.joint_weights;
  MotionEdges edges(checker, options);
  if (edges.steered()) return;
  Rng rng(input.options.seed, 0x736f + 0x10000u * round);
  ShorteningOptions shortening;
  shortening.stopped = [&] { return input.out_of_time(); };
  const double fixed = input.problem.grasps[path.grasp].cost;
  for (const double resolution : {1.0, kSecondResolution}) {
    TransferPath shorter = path;
    // A path that was not the cheapest before it was shortened is the merit of the stage that found it.
    if (path.cost <= result.cost) shorter.stage = PlanStage::shortening;
    shortening.resolution = resolution;
    shorten_path(edges, shorter.path, rng, shortening);
    shorter.cost = input.metric.length(shorter.path.waypoints) + fixed;
    if (shorter.cost > std::min(path.cost, result.cost) - kLeastGain * input.metric.unit() || input.out_of_time())
      return;
    if (input.checks.blocked_edge(path.grasp, shorter.path) < 0) return take_path(input, std::move(shorter), result);
  }
}

}  // namespace mmgrasp::detail
