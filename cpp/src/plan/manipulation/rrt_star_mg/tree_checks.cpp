#include "plan/manipulation/rrt_star_mg/tree_checks.hpp"

namespace mmgrasp::detail {

TreeChecks::TreeChecks(const GraspTrees& trees, TransferChecks& checks, ManipulationStats& stats)
    : trees_(trees), checks_(checks), stats_(stats) {}

Eigen::Map<const Eigen::VectorXd> TreeChecks::values(int configuration) const {
  return {trees_.configuration(configuration), trees_.ends().dimension()};
}

bool TreeChecks::robot_is_free(int grasp, int configuration) {
  const int opening = trees_.ends().opening(grasp);
  if (const auto known = robot_.find(opening, configuration, configuration)) return *known;
  const bool free = checks_.robot_is_free(0, opening, values(configuration));
  robot_.insert(opening, configuration, configuration, free);
  return free;
}

bool TreeChecks::configuration_is_free(int grasp, int configuration) {
  return robot_is_free(grasp, configuration) &&
         checks_.attached_is_free(0, trees_.ends().grasp(grasp), values(configuration));
}

// The object first: it is larger than a link as a rule, and hits first.
bool TreeChecks::edge_is_free(int grasp, int a, int b) {
  if (blocked_.find(grasp, a, b)) return false;
  const int opening = trees_.ends().opening(grasp);
  const auto known = robot_.find(opening, a, b);
  if (known && !*known) return false;
  const Eigen::VectorXd from = values(a), to = trees_.ends().metric().nearest(from, values(b));
  ++stats_.edges_checked_attached;
  if (!checks_.attached_edge_is_free(0, trees_.ends().grasp(grasp), from, to)) return false;
  if (known) return true;
  ++stats_.edges_checked_robot;
  const bool free = checks_.robot_edge_is_free(0, opening, from, to);
  robot_.insert(opening, a, b, free);
  return free;
}

bool TreeChecks::shortcut_is_free(int grasp, int a, int b) {
  const bool free = edge_is_free(grasp, a, b);
  if (!free) blocked_.insert(grasp, a, b, false);
  return free;
}

bool TreeChecks::edge_is_verified(int grasp, int a, int b) {
  if (verified_.find(grasp, a, b)) return true;
  if (blocked_.find(grasp, a, b)) return false;
  const Eigen::VectorXd from = values(a), to = trees_.ends().metric().nearest(from, values(b));
  const bool free = checks_.path_edge_is_free(trees_.ends().grasp(grasp), from, to);
  (free ? verified_ : blocked_).insert(grasp, a, b, free);
  return free;
}

int TreeChecks::blocked_edge(int grasp, const std::vector<int>& vertices) {
  for (std::size_t i = 0; i + 1 < vertices.size(); ++i) {
    const int a = trees_.vertex(vertices[i]).configuration, b = trees_.vertex(vertices[i + 1]).configuration;
    if (!edge_is_verified(grasp, a, b)) return static_cast<int>(i);
  }
  return -1;
}

}  // namespace mmgrasp::detail
