#include "plan/manipulation/rrt_star_mg/path_shortcutting.hpp"

#include <cstddef>
#include <vector>

namespace mmgrasp::detail {
namespace {

constexpr double kBeforeEdgeEnd = 0.999;  // New points on an edge keep off the vertex at its end.

}  // namespace

PathShortcutting::PathShortcutting(GraspTrees& trees, TreeChecks& checks, TreeConnections& connections,
                                   const Incumbent& incumbent, const RrtStarMgTuning& tuning)
    : trees_(trees),
      checks_(checks),
      connections_(connections),
      incumbent_(incumbent),
      tuning_(tuning),
      q_(trees.ends().dimension()) {}

void PathShortcutting::skip_vertices(int grasp) {
  if (!connections_.trace_path(grasp, path_)) return;
  // Successive paths share most vertices, and most of these edges are blocked.
  const auto is_free = [&](int a, int b) {
    return checks_.shortcut_is_free(grasp, trees_.vertex(a).configuration, trees_.vertex(b).configuration);
  };
  for (const std::vector<int>& branch : path_)
    for (std::size_t i = 0; i + 2 < branch.size(); ++i)
      for (std::size_t k = branch.size() - 1; k > i + 1; --k) {
        const double length = trees_.vertex_distance(branch[i], branch[k]);
        if (trees_.vertex(branch[k]).cost + length >= trees_.vertex(branch[i]).cost * (1 - kLeastImprovement)) continue;
        if (!is_free(branch[i], branch[k])) continue;
        trees_.reparent(branch[i], branch[k], length);
        break;
      }
  if (!connections_.trace_path(grasp, path_)) return;
  const double own_cost = connections_.cost(connections_.best(grasp).connection);
  const std::vector<int>&from_start = path_[0], &from_goal = path_[1];
  for (std::size_t i = 0; i < from_start.size(); ++i)
    for (std::size_t k = 0; k < from_goal.size(); ++k) {
      const int a = from_start[from_start.size() - 1 - i], b = from_goal[from_goal.size() - 1 - k];
      const double cost =
          trees_.vertex(a).cost + trees_.vertex_distance(a, b) + trees_.vertex(b).cost + trees_.ends().cost(grasp);
      if (cost >= incumbent_.cost_to_beat() || cost >= own_cost - kSameConfiguration) continue;
      if (!is_free(a, b)) continue;
      connections_.add(a, b);
      return;
    }
}

int PathShortcutting::pick_grasp(Rng& rng, int grasps) {
  if (!(rng.uniform() < tuning_.other_grasp_probability) || !connections_.any_listed()) return incumbent_.grasp;
  return connections_.draw_grasp(rng, grasps);
}

bool PathShortcutting::pick_corner(Rng& rng, const TreeConnections::Branches& path, Corner& out) {
  const std::size_t corners = path[0].size() + path[1].size() - 2;
  if (corners == 0) return false;
  std::size_t at = rng.index(corners);
  const int side = at < path[0].size() - 1 ? 0 : 1;
  if (side == 1) at -= path[0].size() - 1;
  const std::vector<int>& branch = path[side];
  out = {branch[at + 1], branch[at], at > 0 ? branch[at - 1] : path[1 - side].front(), at == 0};
  return true;
}

int PathShortcutting::cut_random_corner(Rng& rng, int grasps) {
  const int grasp = pick_grasp(rng, grasps);
  if (grasp < 0) return -1;
  if (!connections_.trace_path(grasp, path_)) return grasp;
  Corner at;
  if (!pick_corner(rng, path_, at)) return -1;
  // Far from the corner is worth more at first; a path that is nearly shortest can only be cut close to it.
  const bool near_corner = rng.uniform() < tuning_.near_corner_probability;
  int points[2];
  for (int i = 0; i < 2; ++i) {
    const double drawn = rng.uniform() * rng.uniform();
    const double share = near_corner ? drawn : 1 - drawn;
    const double *from = trees_.at(at.corner), *to = trees_.at(i == 0 ? at.before : at.after);
    for (int k = 0; k < trees_.ends().dimension(); ++k) q_[k] = from[k] + (to[k] - from[k]) * share * kBeforeEdgeEnd;
    points[i] = trees_.add_configuration(q_.data());
  }
  if (!checks_.edge_is_free(grasp, points[0], points[1])) return -1;
  const auto distance_from = [&](int vertex, int configuration) {
    return trees_.distance(trees_.vertex(vertex).configuration, configuration);
  };
  const int first = trees_.add(at.before, points[0], distance_from(at.before, points[0]));
  const int second = trees_.add(first, points[1], trees_.distance(points[0], points[1]));
  if (at.at_connection) {
    connections_.add(second, at.after);
  } else {
    trees_.reparent(at.after, second, distance_from(at.after, points[1]));
  }
  return grasp;
}

}  // namespace mmgrasp::detail
