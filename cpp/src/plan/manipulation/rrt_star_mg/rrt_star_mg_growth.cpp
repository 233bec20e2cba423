// Growing trees.

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/detail/ball_volume.hpp"
#include "plan/manipulation/rrt_star_mg/rrt_star_mg.hpp"

namespace mmgrasp::detail {
namespace {

constexpr int kHopeless = -2;
constexpr int kFewest = 4;      // Vertices joined in small trees.
constexpr int kDuplicates = 4;  // Vertices of other trees taken over by one new vertex.

}  // namespace

double RrtStarMg::radius(int vertices) const {
  if (!(options_.gamma > 0)) return options_.step;
  const double n = std::max(2, vertices);
  return std::min(options_.gamma * std::pow(std::log(n) / n, 1.0 / (ends_.dimension() + 1)), options_.step);
}

void RrtStarMg::look_near_in_tree(int tree, const double* q) {
  trees_.near_in_tree(tree, q, radius(trees_.tree_size(tree)), near_);
  keep_near(trees_.tree_size(tree), informed_.volume(GraspTrees::grasp_of(tree)));
}

void RrtStarMg::look_near_on_side(int side, const double* q) {
  trees_.near_on_side(side, q, radius(trees_.side_size(side)), near_);
  keep_near(trees_.side_size(side), informed_.volume());
}

// RRT*'s radius for vertices that are uniform in a set of this volume (Karaman and Frazzoli; of the informed set as in
// Informed RRT* and BIT*) holds 2 (1 + 1/d) log n of them. With 2 n^(1/(d+1)) times as many it is in the end larger
// than any constant times (log n / n)^(1/(d+1)), which Solovey and others ask for. Ellipsoids of good paths are thin,
// and a ball wider than they are holds fewer: as many of the nearest are kept, too.
void RrtStarMg::keep_near(int vertices, double volume) {
  if (options_.gamma > 0) return;
  if (!options_.informed) volume = informed_.box_volume();
  const double n = std::max(2, vertices), d = ends_.dimension();
  const double joined = 4 * (1 + 1 / d) * std::log(n) * std::pow(n, 1 / (d + 1));
  const auto count = static_cast<std::ptrdiff_t>(std::ceil(joined)) + kFewest;
  if (static_cast<std::ptrdiff_t>(near_.size()) <= count) return;
  const auto nearer = [](const Near& a, const Near& b) {
    return a.distance != b.distance ? a.distance < b.distance : a.vertex < b.vertex;
  };
  std::nth_element(near_.begin(), near_.begin() + count, near_.end(), nearer);
  const double ball = std::pow(volume / unit_ball_volume(ends_.dimension()) * joined / n, 1 / d);
  near_.erase(
      std::partition(near_.begin() + count, near_.end(), [&](const Near& near) { return near.distance < ball; }),
      near_.end());
}

int RrtStarMg::steer(int from, int target) {
  const int d = ends_.dimension();
  const double* a = trees_.at(from);
  const double* b = trees_.configuration(target);
  const double distance = std::sqrt(squared_distance(a, b, d));
  if (distance < kSame) return -1;
  if (distance <= options_.step) return target;
  for (int i = 0; i < d; ++i) q_[i] = a[i] + (b[i] - a[i]) * (options_.step / distance);
  return trees_.add_configuration(q_.data());
}

// ExtendAndRewire (Algorithm 5.2) on the tree of one grasp.
int RrtStarMg::extend_tree(int tree, int configuration) {
  const int nearest = trees_.nearest_in_tree(tree, trees_.configuration(configuration));
  const int target = steer(nearest, configuration);
  if (target < 0 || trees_.find(tree, target) >= 0) return -1;
  look_near_in_tree(tree, trees_.configuration(target));
  include_nearest(nearest, target);
  // Where no cheaper path can pass, trees grow only while they are offered the whole box.
  const int made = add_best(target, options_.informed ? best_ : kInfinity);
  if (made == kHopeless) return -1;
  if (made < 0) return solved() ? -1 : advance(nearest, target);
  rewire(made);
  return made;
}

// ExtendAndRewire-MG: the tree that looks cheapest by equation (5.1) among those near.
int RrtStarMg::extend_forest(int side, int configuration) {
  const int nearest = trees_.nearest_on_side(side, trees_.configuration(configuration));
  const int target = steer(nearest, configuration);
  if (target < 0) return -1;
  look_near_on_side(side, trees_.configuration(target));
  include_nearest(nearest, target);
  const int made = add_best(target, best_);
  // No tree nearby can be improved from here; another grasp's may (P2 5.3.4).
  if (made == kHopeless) {
    reassign_.push_back(configuration);
    return -1;
  }
  if (made < 0) return solved() ? -1 : advance(nearest, target);
  rewire(made);
  if (solved()) duplicate_into(made);
  return made;
}

// Beyond the paper, until there is a path.
int RrtStarMg::advance(int from, int target) {
  const GraspTrees::Vertex start = trees_.vertex(from);
  const int grasp = GraspTrees::grasp_of(start.tree), d = ends_.dimension();
  const double *a = trees_.at(from), *b = trees_.configuration(target);
  for (int k = 0; k < d; ++k) q_[k] = 0.5 * (a[k] + b[k]);
  const int half = trees_.add_configuration(q_.data());
  if (!configuration_is_free(grasp, half) || !edge_is_free(grasp, start.configuration, half)) return -1;
  return trees_.add(from, half, std::sqrt(squared_distance(trees_.at(from), trees_.configuration(half), d)));
}

void RrtStarMg::include_nearest(int nearest, int target) {
  for (const Near& entry : near_)
    if (entry.vertex == nearest) return;
  near_.push_back({nearest, length(trees_.vertex(nearest).configuration, target)});
}

int RrtStarMg::add_best(int configuration, double bound) {
  const double* q = trees_.configuration(configuration);
  bool any = false;
  for (Near& entry : near_) {
    const GraspTrees::Vertex& vertex = trees_.vertex(entry.vertex);
    const int grasp = GraspTrees::grasp_of(vertex.tree);
    const auto own = static_cast<std::size_t>(grasp);
    if (to_go_stamp_[own] != configuration) {
      to_go_stamp_[own] = configuration;
      to_go_[own] = ends_.cost(grasp) + ends_.distance(grasp, 1 - GraspTrees::side_of(vertex.tree), q);
    }
    entry.key = vertex.cost + entry.distance + to_go_[own];
    any |= entry.key < bound;
  }
  if (!any) return kHopeless;
  std::make_heap(near_.begin(), near_.end(), costlier);
  for (auto last = near_.end(); last != near_.begin(); --last) {
    std::pop_heap(near_.begin(), last, costlier);
    const Near& entry = *(last - 1);
    if (entry.key >= bound) return -1;
    const GraspTrees::Vertex& vertex = trees_.vertex(entry.vertex);
    const int grasp = GraspTrees::grasp_of(vertex.tree);
    int& blocked = blocked_stamp_[grasp];
    if (blocked == configuration) continue;
    if (!configuration_is_free(grasp, configuration)) {
      blocked = configuration;
      if (input_.checks.opening_count() == 1 && !robot_is_free(grasp, configuration)) return -1;
      continue;
    }
    if (edge_is_free(grasp, vertex.configuration, configuration))
      return trees_.add(entry.vertex, configuration, entry.distance);
  }
  return -1;
}

// Only within the tree (P2 5.3.2), and only what could make the best path better.
void RrtStarMg::rewire(int made) {
  const GraspTrees::Vertex own = trees_.vertex(made);
  const int grasp = GraspTrees::grasp_of(own.tree);
  bool changed = false;
  for (const Near& entry : near_) {
    const GraspTrees::Vertex& other = trees_.vertex(entry.vertex);
    if (other.tree != own.tree || entry.vertex == own.parent || other.parent < 0) continue;
    const double cost = own.cost + entry.distance;
    if (!(cost < other.cost - kSame)) continue;
    if (cost + ends_.cost(grasp) + ends_.distance(grasp, 1 - GraspTrees::side_of(own.tree), trees_.at(entry.vertex)) >=
        best_)
      continue;
    if (!edge_is_free(grasp, own.configuration, other.configuration)) continue;
    trees_.reparent(entry.vertex, made, entry.distance);
    changed = true;
  }
  if (changed && bridge_of_[grasp] >= 0) refresh(grasp);
}

// What stands in other trees nearby and could serve this one (P2 5.3.2).
void RrtStarMg::duplicate_into(int made) {
  const GraspTrees::Vertex own = trees_.vertex(made);
  const int grasp = GraspTrees::grasp_of(own.tree), side = GraspTrees::side_of(own.tree);
  if (!own.alive) return;
  int taken = 0;
  for (std::size_t i = 0; i < near_.size() && taken < kDuplicates; ++i) {
    const Near entry = near_[i];
    const GraspTrees::Vertex other = trees_.vertex(entry.vertex);
    if (!other.alive || other.tree == own.tree || other.parent < 0 || entry.distance < kSame) continue;
    const double cost = own.cost + entry.distance;
    const double whole = cost + ends_.cost(grasp) + ends_.distance(grasp, 1 - side, trees_.at(entry.vertex));
    if (whole >= best_ || trees_.find(own.tree, other.configuration) >= 0) continue;
    if (!configuration_is_free(grasp, other.configuration) ||
        !edge_is_free(grasp, own.configuration, other.configuration))
      continue;
    trees_.add(made, other.configuration, entry.distance);
    ++taken;
  }
}

}  // namespace mmgrasp::detail
