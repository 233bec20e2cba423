#include "structure/object_path/branch_and_bound.hpp"

#include <algorithm>
#include <optional>
#include <queue>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/parallel.hpp"
#include "structure/object_path/collision_proof.hpp"
#include "structure/object_path/grasp_variables.hpp"
#include "structure/object_path/path_bound.hpp"

namespace mmgrasp::detail {
namespace {

constexpr int kRound = 16;          // boxes divided at a time, whatever the number of threads
constexpr double kMetre = 4;        // [rad] An angle as long as a metre along the section when boxes are divided
constexpr double kSmallest = 1e-7;  // [rad] Half angles below are not divided any more

struct Node {
  GraspBox box;
  double bound = 0;
  int number = 0;  ///< Ties go to the older one.
};
struct Later {
  bool operator()(const Node& a, const Node& b) const {
    return a.bound != b.bound ? a.bound > b.bound : a.number > b.number;
  }
};

Grasp middle_of(const Pipe& pipe, const GraspBox& box, const PipeGraspOptions& options) {
  return place_pipe_grasp(pipe, box.section, box.length, box.angle, box.flipped, options);
}

void halve(const GraspBox& box, std::vector<Node>& out) {
  const bool along = box.half_length * kMetre > box.half_angle;
  for (const int side : {-1, 1}) {
    Node half{box};
    if (along) {
      half.box.half_length /= 2;
      half.box.length += side * half.box.half_length;
    } else {
      half.box.half_angle /= 2;
      half.box.angle += side * half.box.half_angle;
    }
    out.push_back(half);
  }
}

}  // namespace

BoxSearch divide_boxes(const ObjectPathProblem& problem, const Pipe& pipe, const ObjectPathOptions& path_options,
                       const GraspSearchOptions& options, double cost, const GraspCounter& count,
                       const TimeLimit& time_limit, const Monitor& monitor) {
  const PathBound bounds(problem, pipe, path_options, options.grasp);
  const int threads = resolve_threads(options.threads);
  std::vector<ObjectPathEvaluator> evaluators;
  std::vector<CollisionProof> proofs;
  for (int i = 0; i < threads; ++i) {
    evaluators.emplace_back(problem, path_options);
    proofs.emplace_back(problem);
  }
  BoxSearch out;
  const GraspVariables sections(pipe, options.grasp);
  std::priority_queue<Node, std::vector<Node>, Later> open;
  std::vector<Node> next;
  for (std::size_t i = 0; i < sections.sections().size(); ++i) {
    for (const bool flipped : {false, true}) {
      const double half = sections.room(static_cast<int>(i)) / 2;
      open.push({{sections.sections()[i], flipped, options.grasp.end_margin + half, half, 0, kPi}, 0, out.boxes++});
    }
  }
  double settled = kInfinity;  // least bound of boxes that are not divided any more
  const auto wanted = [&] { return cost * (1 - options.max_gap); };
  while (!open.empty() && open.top().bound < wanted() && out.boxes < options.max_boxes && !monitor.stopped()) {
    if (time_limit.expired()) break;
    next.clear();
    for (int i = 0; i < kRound && !open.empty() && open.top().bound < wanted(); ++i) {
      const Node node = open.top();
      open.pop();
      if (node.box.half_angle < kSmallest) {
        settled = std::min(settled, node.bound);
      } else {
        halve(node.box, next);
        for (std::size_t k = next.size() - 2; k < next.size(); ++k) next[k].bound = node.bound;
      }
    }
    const double best = cost;
    std::vector<std::optional<ObjectPathResult>> tried(next.size());
    parallel_for(next.size(), threads, [&](std::size_t i, int worker) {
      Node& node = next[i];
      const Grasp grasp = middle_of(pipe, node.box, options.grasp);
      BoxGraph graph = bounds.graph(node.box);
      BoxGraph::Bound bound = graph.bound();
      while (bound.cost < best && proofs[worker].exclude(graph, bound.branches, grasp)) bound = graph.bound();
      node.bound = std::max(node.bound, bound.cost);
      if (node.bound >= best || bound.estimate >= best) return;
      tried[i] = evaluators[worker].evaluate(grasp);
    });
    for (std::size_t i = 0; i < next.size(); ++i) {
      Node& node = next[i];
      node.number = out.boxes++;
      if (tried[i]) {
        const Grasp grasp = middle_of(pipe, node.box, options.grasp);
        if (tried[i]->outcome == Outcome::solved && tried[i]->cost < cost) {
          const ObjectPathResult finer = follow_object_path(problem, grasp, path_options);
          if (finer.outcome == Outcome::solved) {
            cost = std::min(cost, finer.cost);
          } else {
            tried[i]->outcome = finer.outcome;  // what fails the finer check is no candidate
          }
        }
        count(grasp, *tried[i]);
      }
      if (node.bound < cost) open.push(node);
    }
    const double bound = open.empty() ? cost : open.top().bound;
    monitor.report("branch and bound", cost < kInfinity ? std::clamp(bound / wanted(), 0.0, 1.0) : 0.0);
  }
  out.lower_bound = std::min({cost, settled, open.empty() ? kInfinity : open.top().bound});
  return out;
}

}  // namespace mmgrasp::detail
