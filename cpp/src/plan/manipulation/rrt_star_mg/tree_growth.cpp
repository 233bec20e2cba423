#include "plan/manipulation/rrt_star_mg/tree_growth.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {

TreeGrowth::TreeGrowth(GraspTrees& trees, TreeChecks& checks, const NearVertices& near_vertices,
                       const Incumbent& incumbent, const RrtStarMgOptions& options, const RrtStarMgTuning& tuning)
    : trees_(trees),
      checks_(checks),
      near_vertices_(near_vertices),
      incumbent_(incumbent),
      options_(options),
      tuning_(tuning),
      per_grasp_(trees.ends().size()),
      q_(trees.ends().dimension()) {}

int TreeGrowth::extend_tree(int tree, int configuration) {
  const int nearest = trees_.nearest_in_tree(tree, trees_.configuration(configuration));
  const int target = steer(nearest, configuration);
  if (target < 0 || trees_.find(tree, target) >= 0) return -1;
  near_vertices_.in_tree(tree, trees_.configuration(target), nearest, near_);
  // Where no cheaper path can pass, trees grow only while samples are drawn everywhere.
  const Extension made = add_below_best_parent(target, options_.informed ? incumbent_.cost : kInfinity, near_);
  if (made.pruned) return -1;
  if (made.vertex < 0) return incumbent_.in_trees() ? -1 : extend_half(nearest, target);
  rewire(made.vertex, near_);
  return made.vertex;
}

TreeGrowth::Extension TreeGrowth::extend_cheapest_tree(int side, int configuration) {
  const int nearest = trees_.nearest_on_side(side, trees_.configuration(configuration));
  const int target = steer(nearest, configuration);
  if (target < 0) return {};
  near_vertices_.on_side(side, trees_.configuration(target), nearest, near_);
  const Extension made = add_below_best_parent(target, incumbent_.cost, near_);
  if (made.pruned) return made;
  if (made.vertex < 0) return incumbent_.in_trees() ? made : Extension{extend_half(nearest, target)};
  rewire(made.vertex, near_);
  if (incumbent_.in_trees()) duplicate(made.vertex, near_);
  return made;
}

int TreeGrowth::steer(int from, int target) {
  const int d = trees_.ends().dimension();
  const JointMetric& metric = trees_.ends().metric();
  const double* a = trees_.at(from);
  const double* b = trees_.configuration(target);
  const double distance = std::sqrt(metric.squared_distance(a, b, d));
  if (distance < kSameConfiguration * metric.unit()) return -1;
  if (distance <= options_.range) return target;
  for (int i = 0; i < d; ++i) q_[i] = a[i] + (metric.nearest(i, a[i], b[i]) - a[i]) * (options_.range / distance);
  metric.wrap(q_.data());
  return trees_.add_configuration(q_.data());
}

int TreeGrowth::extend_half(int from, int target) {
  const GraspTrees::Vertex start = trees_.vertex(from);
  const int grasp = GraspTrees::grasp_of(start.tree), d = trees_.ends().dimension();
  const double *a = trees_.at(from), *b = trees_.configuration(target);
  const JointMetric& metric = trees_.ends().metric();
  for (int k = 0; k < d; ++k) q_[k] = 0.5 * (a[k] + metric.nearest(k, a[k], b[k]));
  metric.wrap(q_.data());
  const int half = trees_.add_configuration(q_.data());
  if (!checks_.configuration_is_free(grasp, half) || !checks_.edge_is_free(grasp, start.configuration, half)) return -1;
  return trees_.add(from, half, trees_.distance(start.configuration, half));
}

double TreeGrowth::cost_to_go(int grasp, int side, const double* q) const {
  return trees_.ends().cost(grasp) + trees_.ends().distance(grasp, 1 - side, q);
}

TreeGrowth::Extension TreeGrowth::add_below_best_parent(int configuration, double bound, std::vector<Near>& near) {
  const double* q = trees_.configuration(configuration);
  bool any = false;
  for (Near& entry : near) {
    const GraspTrees::Vertex& vertex = trees_.vertex(entry.vertex);
    const int grasp = GraspTrees::grasp_of(vertex.tree);
    PerGrasp& known = per_grasp_[grasp];
    if (known.cost_to_go_of != configuration) {
      known.cost_to_go_of = configuration;
      known.cost_to_go = cost_to_go(grasp, GraspTrees::side_of(vertex.tree), q);
    }
    entry.key = vertex.cost + entry.distance + known.cost_to_go;
    any |= entry.key < bound;
  }
  if (!any) return {-1, true};
  std::make_heap(near.begin(), near.end(), costlier);
  for (auto last = near.end(); last != near.begin(); --last) {
    std::pop_heap(near.begin(), last, costlier);
    const Near& entry = *(last - 1);
    if (entry.key >= bound) return {};
    const GraspTrees::Vertex& vertex = trees_.vertex(entry.vertex);
    const int grasp = GraspTrees::grasp_of(vertex.tree);
    int& blocked_at = per_grasp_[grasp].blocked_at;
    if (blocked_at == configuration) continue;
    if (!checks_.configuration_is_free(grasp, configuration)) {
      blocked_at = configuration;
      if (checks_.one_opening() && !checks_.robot_is_free(grasp, configuration)) return {};
      continue;
    }
    if (checks_.edge_is_free(grasp, vertex.configuration, configuration))
      return {trees_.add(entry.vertex, configuration, entry.distance)};
  }
  return {};
}

void TreeGrowth::rewire(int made, const std::vector<Near>& near) {
  const GraspTrees::Vertex own = trees_.vertex(made);
  const int grasp = GraspTrees::grasp_of(own.tree), side = GraspTrees::side_of(own.tree);
  bool changed = false;
  for (const Near& entry : near) {
    const GraspTrees::Vertex& other = trees_.vertex(entry.vertex);
    if (other.tree != own.tree || entry.vertex == own.parent || other.parent < 0) continue;
    const double cost = own.cost + entry.distance;
    if (!(cost < other.cost - kSameConfiguration * trees_.ends().metric().unit())) continue;
    if (cost + trees_.ends().cost(grasp) + trees_.ends().distance(grasp, 1 - side, trees_.at(entry.vertex)) >=
        incumbent_.cost)
      continue;
    if (!checks_.edge_is_free(grasp, own.configuration, other.configuration)) continue;
    trees_.reparent(entry.vertex, made, entry.distance);
    changed = true;
  }
  if (changed) on_rewired(grasp);
}

void TreeGrowth::duplicate(int made, const std::vector<Near>& near) {
  const GraspTrees::Vertex own = trees_.vertex(made);
  const int grasp = GraspTrees::grasp_of(own.tree), side = GraspTrees::side_of(own.tree);
  if (!own.alive) return;
  int taken = 0;
  for (std::size_t i = 0; i < near.size() && taken < tuning_.max_duplicates; ++i) {
    const Near entry = near[i];
    const GraspTrees::Vertex other = trees_.vertex(entry.vertex);
    if (!other.alive || other.tree == own.tree || other.parent < 0 ||
        entry.distance < kSameConfiguration * trees_.ends().metric().unit())
      continue;
    const double cost = own.cost + entry.distance;
    const double whole =
        cost + trees_.ends().cost(grasp) + trees_.ends().distance(grasp, 1 - side, trees_.at(entry.vertex));
    if (whole >= incumbent_.cost || trees_.find(own.tree, other.configuration) >= 0) continue;
    if (!checks_.configuration_is_free(grasp, other.configuration) ||
        !checks_.edge_is_free(grasp, own.configuration, other.configuration))
      continue;
    trees_.add(made, other.configuration, entry.distance);
    ++taken;
  }
}

}  // namespace mmgrasp::detail
