// Collisions, and paths through pairs of trees.

#include <algorithm>
#include <cmath>
#include <limits>

#include "plan/manipulation/rrt_star_mg/rrt_star_mg.hpp"

namespace mmgrasp::detail {
namespace {

constexpr double kSlack = 1e-9;     // Rounding of estimates: the best path's own vertices stay.
constexpr double kPromising = 1.5;  // Paths of other grasps worth keeping, by the best one.

}  // namespace

bool RrtStarMg::robot_is_free(int grasp, int configuration) {
  const int opening = ends_.opening(grasp);
  const int known = robot_.recall(opening, configuration, configuration);
  if (known >= 0) return known == 1;
  std::copy_n(trees_.configuration(configuration), q_a_.size(), q_a_.data());
  const bool free = input_.checks.robot_is_free(0, opening, q_a_);
  robot_.keep(opening, configuration, configuration, free);
  return free;
}

bool RrtStarMg::configuration_is_free(int grasp, int configuration) {
  if (!robot_is_free(grasp, configuration)) return false;
  std::copy_n(trees_.configuration(configuration), q_a_.size(), q_a_.data());
  return input_.checks.held_is_free(0, ends_.grasp(grasp), q_a_);
}

// Both ends are known to be free. What is held is larger than a link as a rule, and hits first.
bool RrtStarMg::edge_is_free(int grasp, int a, int b) {
  const int opening = ends_.opening(grasp);
  const int known = robot_.recall(opening, a, b);
  if (known == 0) return false;
  std::copy_n(trees_.configuration(a), q_a_.size(), q_a_.data());
  std::copy_n(trees_.configuration(b), q_b_.size(), q_b_.data());
  ++result_.stats.edges_checked_held;
  if (!input_.checks.held_edge_is_free(0, ends_.grasp(grasp), q_a_, q_b_)) return false;
  if (known == 1) return true;
  ++result_.stats.edges_checked_robot;
  const bool free = input_.checks.robot_edge_is_free(0, opening, q_a_, q_b_);
  robot_.keep(opening, a, b, free);
  return free;
}

double RrtStarMg::cost_of(const Bridge& bridge) const {
  return ends_.cost(GraspTrees::grasp_of(trees_.vertex(bridge.a).tree)) + trees_.vertex(bridge.a).cost + bridge.length +
         trees_.vertex(bridge.b).cost;
}

// ConnectTrees (Algorithm 5.7): a free edge from the new vertex to the other tree of its grasp, the cheapest one.
bool RrtStarMg::connect(int vertex) {
  const GraspTrees::Vertex own = trees_.vertex(vertex);
  if (!own.alive) return false;
  const int d = ends_.dimension();
  const int grasp = GraspTrees::grasp_of(own.tree), side = GraspTrees::side_of(own.tree),
            other = GraspTrees::tree(grasp, 1 - side);
  const int nearest = trees_.nearest_in_tree(other, trees_.at(vertex));
  const double* from = trees_.at(nearest);
  const double* to = trees_.at(vertex);
  const double distance = std::sqrt(squared_distance(from, to, d));
  const double share = distance > options_.step ? options_.step / distance : 1;
  for (int i = 0; i < d; ++i) q_[i] = from[i] + (to[i] - from[i]) * share;
  look_near_in_tree(other, q_.data());
  include_nearest(nearest, own.configuration);
  for (Near& entry : near_) {
    entry.distance = std::sqrt(squared_distance(trees_.at(entry.vertex), to, d));
    entry.key = trees_.vertex(entry.vertex).cost + entry.distance;
  }
  std::make_heap(near_.begin(), near_.end(), costlier);
  const double before = own.cost + ends_.cost(grasp);
  // A grasp without a path of its own may begin with one that is somewhat too long: corners will be cut.
  const double bound =
      grasp == best_grasp_ ? best_ * (1 - kBetter) : std::min(best_ * kPromising, own_[grasp].cost * (1 - kBetter));
  for (auto last = near_.end(); last != near_.begin(); --last) {
    std::pop_heap(near_.begin(), last, costlier);
    const Near entry = *(last - 1);
    if (before + entry.key >= bound) return false;
    if (!edge_is_free(grasp, trees_.vertex(entry.vertex).configuration, own.configuration)) continue;
    add_bridge(vertex, entry.vertex);
    if (own_[grasp].bridge < 0) contenders_.push_back(grasp);
    refresh(grasp);
    return true;
  }
  if (!solved() && options_.bidirectional) advance(nearest, own.configuration);
  return false;
}

void RrtStarMg::refresh(int grasp) {
  for (;;) {
    int* link = &bridge_of_[grasp];
    Own& own = own_[grasp];
    own = {};
    while (*link >= 0) {
      const int index = *link;
      Bridge& bridge = bridges_[index];
      if (!trees_.vertex(bridge.a).alive || !trees_.vertex(bridge.b).alive) {
        *link = bridge.next;
        continue;
      }
      const double cost = cost_of(bridge);
      if (cost < own.cost) own = {cost, index};
      link = &bridge.next;
    }
    if (!(own.cost < best_ * (1 - kBetter))) return;
    if (accept(own.bridge)) {
      best_grasp_ = grasp;
      prune();
      if (best_ <= options_.goal_cost) return;
      straighten(grasp);
    }
  }
}

// The path in full: from the start to the bridge, and on to the goal.
bool RrtStarMg::accept(int index) {
  const Bridge bridge = bridges_[index];
  const int tree = trees_.vertex(bridge.a).tree;
  const int grasp = GraspTrees::grasp_of(tree);
  nodes_.clear();
  for (int v = bridge.a; v >= 0; v = trees_.vertex(v).parent) nodes_.push_back(v);
  std::reverse(nodes_.begin(), nodes_.end());
  const std::size_t crossing = nodes_.size();
  for (int v = bridge.b; v >= 0; v = trees_.vertex(v).parent) nodes_.push_back(v);
  JointPath path;
  for (const int v : nodes_)
    path.waypoints.push_back(Eigen::Map<const Eigen::VectorXd>(trees_.at(v), ends_.dimension()));
  const int blocked = blocked_edge(grasp, path);
  if (blocked < 0) {
    best_ = cost_of(bridge);
    take_path(input_, {ends_.grasp(grasp), best_, std::move(path)}, result_);
    return true;
  }
  // A thin obstacle was stepped over: what hangs on that edge goes.
  const auto edge = static_cast<std::size_t>(blocked);
  if (edge + 1 == crossing) {
    unbridge(grasp, index);
  } else {
    const int below = edge + 1 < crossing ? nodes_[edge + 1] : nodes_[edge];
    trees_.remove_below(below, [](int) {});
  }
  return false;
}

double RrtStarMg::apart(int a, int b) const {
  return length(trees_.vertex(a).configuration, trees_.vertex(b).configuration);
}

double RrtStarMg::length(int a, int b) const {
  return std::sqrt(squared_distance(trees_.configuration(a), trees_.configuration(b), ends_.dimension()));
}

void RrtStarMg::add_bridge(int a, int b) {
  const int grasp = GraspTrees::grasp_of(trees_.vertex(a).tree);
  const bool swap = GraspTrees::side_of(trees_.vertex(a).tree) == GraspEnds::kGoal;
  int& head = bridge_of_[grasp];
  bridges_.push_back({swap ? b : a, swap ? a : b, apart(a, b), head});
  head = static_cast<int>(bridges_.size()) - 1;
}

int RrtStarMg::blocked_edge(int grasp, const JointPath& path) {
  for (std::size_t i = 0; i + 1 < nodes_.size(); ++i) {
    const int a = trees_.vertex(nodes_[i]).configuration, b = trees_.vertex(nodes_[i + 1]).configuration;
    if (verified_.recall(grasp, a, b) == 1) continue;
    if (!input_.checks.path_edge_is_free(ends_.grasp(grasp), path.waypoints[i], path.waypoints[i + 1]))
      return static_cast<int>(i);
    verified_.keep(grasp, a, b, true);
  }
  return -1;
}

void RrtStarMg::unbridge(int grasp, int index) {
  int* link = &bridge_of_[grasp];
  while (*link != index) link = &bridges_[*link].next;
  *link = bridges_[index].next;
}

// PruneAndReassign: trees of grasps that cannot win any more, and leaves outside of their informed sets.
void RrtStarMg::prune() {
  const int before = informed_.grasps();
  informed_.set_cost(best_ * (1 - kBetter));
  for (int grasp = informed_.grasps(); grasp < before; ++grasp)
    for (const int side : {GraspEnds::kStart, GraspEnds::kGoal}) {
      nodes_.clear();
      trees_.each_in_tree(GraspTrees::tree(grasp, side), [&](int v) { nodes_.push_back(v); });
      for (const int v : nodes_)
        if (trees_.vertex(v).alive && trees_.vertex(v).parent < 0)
          trees_.remove_below(v, [&](int gone) { leaving(gone); });
    }
  const double bound = best_ * (1 + kSlack);
  for (int v = 0; v < trees_.vertex_count(); ++v) {
    for (int u = v; u >= 0;) {
      const GraspTrees::Vertex& vertex = trees_.vertex(u);
      if (!vertex.alive || vertex.first_child >= 0 || vertex.parent < 0 || vertex.estimate <= bound) break;
      const int parent = vertex.parent;
      leaving(u);
      trees_.remove_leaf(u);
      u = parent;
    }
  }
}

// Before a vertex is removed. Roots are arm configurations of their own grasp and serve no other.
void RrtStarMg::leaving(int v) {
  const GraspTrees::Vertex& vertex = trees_.vertex(v);
  if (vertex.parent >= 0 && trees_.only_one(v)) reassign_.push_back(vertex.configuration);
}

}  // namespace mmgrasp::detail
