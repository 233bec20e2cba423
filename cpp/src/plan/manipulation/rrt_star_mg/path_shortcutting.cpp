#include "plan/manipulation/rrt_star_mg/path_shortcutting.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace mmgrasp::detail {
namespace {

constexpr double kLeastShare = 1e-5;  // Corners are not cut closer than this share of an edge.
constexpr double kHidden = 3e-4;      // A step of the final check, which may hide a cut corner [rad or m].
constexpr double kLiftProbability = 0.5;

}  // namespace

PathShortcutting::PathShortcutting(GraspTrees& trees, TreeChecks& checks, TreeConnections& connections,
                                   const Incumbent& incumbent, const RrtStarMgTuning& tuning)
    : trees_(trees),
      checks_(checks),
      connections_(connections),
      incumbent_(incumbent),
      tuning_(tuning),
      moves_(trees.ends().dimension()),
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
        // Also when that is no shorter: a vertex on a straight line is one corner too many.
        if (!is_free(branch[i], branch[k])) continue;
        trees_.reparent(branch[i], branch[k], trees_.vertex_distance(branch[i], branch[k]));
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
      if (cost >= incumbent_.cost_to_beat() || cost >= own_cost - kSameConfiguration * trees_.ends().metric().unit())
        continue;
      if (!is_free(a, b)) continue;
      connections_.add(a, b);
      return;
    }
}

int PathShortcutting::pick_grasp(Rng& rng, int grasps) {
  if (!(rng.uniform() < tuning_.other_grasp_probability) || !connections_.any_listed()) return incumbent_.grasp;
  return connections_.draw_grasp(rng, grasps);
}

int PathShortcutting::improve_randomly(Rng& rng, int grasps) {
  const int grasp = pick_grasp(rng, grasps);
  if (grasp < 0) return -1;
  const int connection = connections_.best(grasp).connection;
  if (!connections_.trace_path(grasp, path_)) return grasp;
  vertices_ = connections_.vertices(connection, crossing_);
  if (vertices_.size() < 3) return -1;
  const bool improved = rng.uniform() < tuning_.joint_shortcut_probability ? shortcut_some_joints(rng, grasp)
                                                                           : shortcut_corner(rng, grasp);
  return improved ? grasp : -1;
}

bool PathShortcutting::shortcut_corner(Rng& rng, int grasp) {
  const std::size_t corner = 1 + rng.index(vertices_.size() - 2);
  // Between two steps of its check an edge may cut a corner of an obstacle, and nothing near it passes the check again:
  // no part of it, and no edge with the same ends in some joints. Points on the side away from the obstacle do, and
  // cost next to nothing.
  const double lift = rng.uniform() < kLiftProbability ? std::pow(kLeastShare, rng.uniform()) : 0;
  made_.clear();
  for (const std::size_t neighbour : {corner - 1, corner + 1}) {
    const double share = draw_share(rng);
    if (share < 1) made_.push_back(point_beside_edge(corner, neighbour, share, lift));
  }
  return replace(grasp, corner - 1, corner + 1) == Replaced::yes;
}

// An obstacle that holds a corner in some joints leaves it free to move in the others. Corners close to each other can
// only move together.
bool PathShortcutting::shortcut_some_joints(Rng& rng, int grasp) {
  const std::size_t first = rng.index(vertices_.size() - 2);
  const std::size_t last = first + 2 + rng.index(vertices_.size() - first - 2);
  const double share = draw_share(rng);
  const int d = trees_.ends().dimension();
  for (int k = 0; k < d; ++k) moves_[k] = rng.uniform() < 0.5 ? share : 0;
  const JointMetric& metric = trees_.ends().metric();
  std::vector<Eigen::VectorXd> way;
  for (std::size_t i = first; i <= last; ++i)
    way.emplace_back(Eigen::Map<const Eigen::VectorXd>(trees_.at(vertices_[i]), d));
  metric.unroll(way);
  double whole = 0, passed = 0;
  for (std::size_t i = first; i < last; ++i) whole += trees_.vertex_distance(vertices_[i], vertices_[i + 1]);
  if (!(whole > 0)) return false;  // vertices in one place
  const auto replace_lifted = [&](double lift) {
    made_.clear();
    passed = 0;
    for (std::size_t i = first + 1; i < last; ++i) {
      passed += trees_.vertex_distance(vertices_[i - 1], vertices_[i]);
      const Eigen::VectorXd &from = way.front(), &to = way.back(), &own = way[i - first];
      for (int k = 0; k < d; ++k) q_[k] = own[k] + moves_[k] * (from[k] + passed / whole * (to[k] - from[k]) - own[k]);
      lift_out(i, lift * whole);
      metric.wrap(q_.data());
      made_.push_back(trees_.add_configuration(q_.data()));
    }
    return replace(grasp, first, last);
  };
  const Replaced replaced = replace_lifted(0);
  if (replaced != Replaced::blocked) return replaced == Replaced::yes;
  // Where an edge cuts a corner unseen, as in shortcut_corner(): a tenth to ten times what the check may miss.
  return replace_lifted(kHidden * metric.unit() * std::pow(10, 2 * rng.uniform() - 1) / whole) == Replaced::yes;
}

PathShortcutting::Replaced PathShortcutting::replace(int grasp, std::size_t first, std::size_t last) {
  double gain = 0;
  for (std::size_t i = first; i < last; ++i) gain += trees_.vertex_distance(vertices_[i], vertices_[i + 1]);
  made_.insert(made_.begin(), trees_.vertex(vertices_[first]).configuration);
  made_.push_back(trees_.vertex(vertices_[last]).configuration);
  for (std::size_t i = 0; i + 1 < made_.size(); ++i) gain -= trees_.distance(made_[i], made_[i + 1]);
  if (gain < kLeastImprovement * connections_.best(grasp).cost) return Replaced::not_shorter;
  for (std::size_t i = 1; i + 1 < made_.size(); ++i)
    if (!checks_.configuration_is_free(grasp, made_[i])) return Replaced::blocked;
  // The edge in the middle first: those of a cut corner beside it are parts of free edges.
  const std::size_t edges = made_.size() - 1;
  for (std::size_t k = 0; k < edges; ++k) {
    const std::size_t i = (k + edges / 2) % edges;
    if (!checks_.edge_is_verified(grasp, made_[i], made_[i + 1])) return Replaced::blocked;
  }
  // Vertices are made from the end that is nearer to the root of its tree.
  const bool from_start = first < crossing_;
  if (!from_start) {
    std::reverse(made_.begin(), made_.end());
    std::swap(first, last);
  }
  int at = vertices_[first];
  for (std::size_t i = 1; i + 1 < made_.size(); ++i)
    at = trees_.add(at, made_[i], trees_.distance(made_[i - 1], made_[i]));
  const int end = vertices_[last];
  if (from_start && last >= crossing_) {
    connections_.add(at, end);
  } else {
    trees_.reparent(end, at, trees_.vertex_distance(at, end));
  }
  return Replaced::yes;
}

// All orders of magnitude occur: how far from a corner the obstacle is does not matter, and the last thousandth is
// gained as fast as the first tenth.
double PathShortcutting::draw_share(Rng& rng) {
  const double kind = 3 * rng.uniform();
  if (kind < 1) return 1;
  return kind < 2 ? rng.uniform() : std::pow(kLeastShare, rng.uniform());
}

void PathShortcutting::lift_out(std::size_t corner, double length) {
  if (length == 0) return;
  const JointMetric& metric = trees_.ends().metric();
  const double* at = trees_.at(vertices_[corner]);
  for (const std::size_t neighbour : {corner - 1, corner + 1}) {
    const double* other = trees_.at(vertices_[neighbour]);
    const double apart = std::max(trees_.vertex_distance(vertices_[corner], vertices_[neighbour]), kSameConfiguration);
    for (int k = 0; k < trees_.ends().dimension(); ++k)
      q_[k] -= length / apart * (metric.nearest(k, at[k], other[k]) - at[k]);
  }
}

int PathShortcutting::point_beside_edge(std::size_t corner, std::size_t neighbour, double share, double lift) {
  const JointMetric& metric = trees_.ends().metric();
  const double *at = trees_.at(vertices_[corner]), *to = trees_.at(vertices_[neighbour]);
  for (int k = 0; k < trees_.ends().dimension(); ++k) q_[k] = at[k] + share * (metric.nearest(k, at[k], to[k]) - at[k]);
  lift_out(corner, lift * trees_.vertex_distance(vertices_[corner], vertices_[neighbour]));
  metric.wrap(q_.data());
  return trees_.add_configuration(q_.data());
}

}  // namespace mmgrasp::detail
