#include "plan/carry_shortening.hpp"

#include <utility>

#include "plan/motion_edges.hpp"
#include "plan/shortening.hpp"

namespace mmgrasp::detail {
namespace {

constexpr double kFiner = 8;       // Of a second try, when the first has cut a thin obstacle.
constexpr double kNothing = 1e-9;  // Gain that is none.

}  // namespace

void shorten_carry(const CarryInput& input, ManipulationResult& result) {
  const int grasp = result.grasp_index;
  CollisionChecker checker = input.checks.whole(grasp);
  MotionOptions options;
  options.edge_step = input.options.edge.joint_step;
  options.workspace_step = input.options.edge.workspace_step;
  MotionEdges edges(checker, options);
  if (edges.steered()) return;
  Rng rng(input.options.seed, 0x736f);
  ShorteningOptions shortening;
  shortening.stopped = [&] { return input.out_of_time(); };
  for (const double finer : {1.0, kFiner}) {
    JointPath path = *result.path;
    shortening.finer = finer;
    shorten_path(edges, path, rng, shortening);
    const double cost = path.length() + input.problem.grasps[static_cast<std::size_t>(grasp)].cost;
    if (cost > result.cost - kNothing || input.out_of_time()) return;
    if (input.checks.blocked_edge(grasp, path) < 0) return take_path(input, grasp, cost, std::move(path), result);
  }
}

}  // namespace mmgrasp::detail
