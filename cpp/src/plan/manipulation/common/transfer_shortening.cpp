#include "plan/manipulation/common/transfer_shortening.hpp"

#include <algorithm>
#include <utility>

#include "plan/motion/motion_edges.hpp"
#include "plan/motion/shortening.hpp"

namespace mmgrasp::detail {
namespace {

constexpr double kFiner = 8;       // Of a second try, when the first has cut a thin obstacle.
constexpr double kNothing = 1e-9;  // Gain that is none.

}  // namespace

void shorten_transfer(const ManipulationInput& input, const TransferPath& carry, ManipulationResult& result,
                      unsigned round) {
  CollisionChecker checker = input.checks.whole(carry.grasp);
  MotionOptions options;
  options.edge_step = input.options.edge.joint_step;
  options.workspace_step = input.options.edge.workspace_step;
  MotionEdges edges(checker, options);
  if (edges.steered()) return;
  Rng rng(input.options.seed, 0x736f + 0x10000u * round);
  ShorteningOptions shortening;
  shortening.stopped = [&] { return input.out_of_time(); };
  const double fixed = input.problem.grasps[carry.grasp].cost;
  for (const double finer : {1.0, kFiner}) {
    TransferPath shorter = carry;
    shortening.finer = finer;
    shorten_path(edges, shorter.path, rng, shortening);
    shorter.cost = shorter.path.length() + fixed;
    if (shorter.cost > std::min(carry.cost, result.cost) - kNothing || input.out_of_time()) return;
    if (input.checks.blocked_edge(carry.grasp, shorter.path) < 0) return take_path(input, std::move(shorter), result);
  }
}

}  // namespace mmgrasp::detail
