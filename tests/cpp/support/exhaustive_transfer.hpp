#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include "mmgrasp/collision/edge.hpp"
#include "mmgrasp/plan/manipulation.hpp"
#include "mmgrasp/robot/ik.hpp"
#include "support/around.hpp"
#include "support/bar_transfer.hpp"

namespace mmgrasp::test {

/// The cheapest path of one grasp over the roadmap by Dijkstra's algorithm, every edge checked beforehand with the bar
/// in hand; angles that wrap go the short way round.
inline double exhaustive_cost(const ManipulationProblem& problem, const ManipulationOptions& options,
                              const Roadmap& roadmap, int index) {
  const Grasp& grasp = problem.grasps[index];
  const std::vector<bool>& wraps = problem.group.wraps();
  CollisionChecker checker(problem.group, carrying(problem, grasp));
  IkOptions ik = options.ik;
  ik.seed = options.ik.seed + static_cast<unsigned>(index);
  const auto solve = [&](const Pose& T) {
    return solve_ik_all(problem.group, T * grasp.T_object_hand, options.ik_solutions, ik,
                        [&](const Eigen::VectorXd& q) { return checker.rejection(q); });
  };
  std::vector<Eigen::VectorXd> nodes;
  for (int v = 0; v < roadmap.size(); ++v) nodes.push_back(roadmap.vertices().col(v));
  const auto first_start = nodes.size();
  for (const auto& q : solve(problem.T_world_start)) nodes.push_back(q);
  const auto first_goal = nodes.size();
  for (const auto& q : solve(problem.T_world_goal)) nodes.push_back(q);
  if (first_goal == first_start || nodes.size() == first_goal) return std::numeric_limits<double>::infinity();

  std::vector<std::vector<std::pair<std::size_t, double>>> arcs(nodes.size());
  const auto join = [&](std::size_t a, std::size_t b) {
    if (!checker.is_free(nodes[a]) || !checker.is_free(nodes[b])) return;
    if (!check_edge(checker, nodes[a], nearest_image(wraps, nodes[a], nodes[b]), options.edge).free) return;
    arcs[a].push_back({b, distance_around(wraps, nodes[a], nodes[b])});
    arcs[b].push_back({a, distance_around(wraps, nodes[a], nodes[b])});
  };
  const double radius = options.prm.roadmap.gamma * std::pow(std::log(double(roadmap.size())) / roadmap.size(),
                                                             1.0 / static_cast<double>(problem.group.size()));
  for (std::size_t a = 0; a < nodes.size(); ++a)
    for (std::size_t b = a + 1; b < nodes.size(); ++b) {
      const bool ends = a >= first_start && a < first_goal && b >= first_goal;
      const bool same_end = a >= first_start && !ends;
      const bool near = !same_end && distance_around(wraps, nodes[a], nodes[b]) < radius;
      if (near || (ends && options.straight)) join(a, b);
    }
  std::vector<double> cost(nodes.size(), std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  for (std::size_t s = first_start; s < first_goal; ++s) queue.push({cost[s] = 0, s});
  while (!queue.empty()) {
    const auto [at, node] = queue.top();
    queue.pop();
    if (at > cost[node]) continue;
    if (node >= first_goal) return at + grasp.cost;
    for (const auto& [next, length] : arcs[node])
      if (at + length < cost[next]) queue.push({cost[next] = at + length, next});
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace mmgrasp::test
