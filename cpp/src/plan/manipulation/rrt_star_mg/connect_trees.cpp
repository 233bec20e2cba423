#include "plan/manipulation/rrt_star_mg/connect_trees.hpp"

#include <algorithm>
#include <cmath>

namespace mmgrasp::detail {

ConnectTrees::ConnectTrees(const GraspTrees& trees, TreeChecks& checks, const NearVertices& near_vertices,
                           const Incumbent& incumbent, TreeConnections& connections, const RrtStarMgOptions& options,
                           const RrtStarMgTuning& tuning)
    : trees_(trees),
      checks_(checks),
      near_vertices_(near_vertices),
      incumbent_(incumbent),
      connections_(connections),
      options_(options),
      tuning_(tuning),
      q_(trees.ends().dimension()) {}

// Paths of other grasps than the best one's may be somewhat too long: shortcutting makes them shorter.
double ConnectTrees::bound(int grasp) const {
  if (grasp == incumbent_.grasp) return incumbent_.cost_to_beat();
  return std::min(incumbent_.cost * tuning_.first_connection_bound,
                  connections_.best(grasp).cost * (1 - kLeastImprovement));
}

ConnectTrees::Attempt ConnectTrees::connect(int vertex) {
  const GraspTrees::Vertex own = trees_.vertex(vertex);
  if (!own.alive) return {};
  const int d = trees_.ends().dimension();
  const JointMetric& metric = trees_.ends().metric();
  const int grasp = GraspTrees::grasp_of(own.tree);
  const int other = GraspTrees::tree(grasp, 1 - GraspTrees::side_of(own.tree));
  const int nearest = trees_.nearest_in_tree(other, trees_.at(vertex));
  const double* from = trees_.at(nearest);
  const double* to = trees_.at(vertex);
  const double distance = std::sqrt(metric.squared_distance(from, to, d));
  const double share = distance > options_.range ? options_.range / distance : 1;
  for (int i = 0; i < d; ++i) q_[i] = from[i] + (metric.nearest(i, from[i], to[i]) - from[i]) * share;
  near_vertices_.in_tree(other, q_.data(), nearest, near_);
  for (GraspTrees::Near& entry : near_) {
    entry.distance = std::sqrt(metric.squared_distance(trees_.at(entry.vertex), to, d));
    entry.key = trees_.vertex(entry.vertex).cost + entry.distance;
  }
  std::make_heap(near_.begin(), near_.end(), costlier);
  const double before = own.cost + trees_.ends().cost(grasp), bound = this->bound(grasp);
  // Beside a wall hundreds would lead through it.
  int tried = 0;
  for (auto last = near_.end(); last != near_.begin() && tried < tuning_.max_connections; --last, ++tried) {
    std::pop_heap(near_.begin(), last, costlier);
    const GraspTrees::Near entry = *(last - 1);
    if (before + entry.key >= bound) return {};
    if (!checks_.edge_is_free(grasp, trees_.vertex(entry.vertex).configuration, own.configuration)) continue;
    connections_.add(vertex, entry.vertex);
    if (connections_.best(grasp).connection < 0) connections_.list_grasp(grasp);
    return {true};
  }
  return {false, nearest};
}

}  // namespace mmgrasp::detail
