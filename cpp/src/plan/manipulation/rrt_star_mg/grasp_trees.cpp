#include "plan/manipulation/rrt_star_mg/grasp_trees.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {
namespace {

constexpr int kMaxScannedVertices = 64;     // Trees of up to so many vertices are scanned ...
constexpr double kScannedShare = 1.0 / 64;  // ... and larger ones that hold less than this share of their side.

}  // namespace

GraspTrees::GraspTrees(const GraspEnds& ends)
    : ends_(ends),
      dimension_(ends.dimension()),
      trees_(2 * ends.size()),
      index_{TreeIndex(ends.dimension(), ends.metric()), TreeIndex(ends.dimension(), ends.metric())} {
  for (int g = 0; g < ends.size(); ++g)
    for (const int side : {GraspEnds::kStart, GraspEnds::kGoal})
      for (int k = 0; k < ends.count(g, side); ++k)
        create(tree(g, side), -1, add_configuration(ends.end(g, side, k)), 0);
}

int GraspTrees::add_configuration(const double* q) {
  // `q` may not be one of our own: the vector moves.
  values_.insert(values_.end(), q, q + dimension_);
  duplicates_.push_back(-1);
  return configuration_count() - 1;
}

int GraspTrees::create(int tree, int parent, int configuration, double cost) {
  const int v = vertex_count();
  Vertex made{configuration, tree, parent, cost, ends_.estimate(grasp_of(tree), this->configuration(configuration))};
  Tree& own = trees_[tree];
  made.next_in_tree = own.first;
  made.next_duplicate = duplicates_[configuration];
  if (own.first >= 0) vertices_[own.first].previous_in_tree = v;
  own.first = v;
  ++own.size;
  duplicates_[configuration] = v;
  vertices_.push_back(made);
  ++side_size_[side_of(tree)];
  return v;
}

int GraspTrees::add(int parent, int configuration, double length) {
  const int v = create(vertex(parent).tree, parent, configuration, vertex(parent).cost + length);
  Vertex& own = vertices_[v];
  Vertex& above = vertices_[parent];
  own.next_sibling = above.first_child;
  if (above.first_child >= 0) vertices_[above.first_child].previous_sibling = v;
  above.first_child = v;
  return v;
}

void GraspTrees::unlink(int v) {
  Vertex& own = vertices_[v];
  if (own.parent < 0) return;
  if (own.previous_sibling >= 0) {
    vertices_[own.previous_sibling].next_sibling = own.next_sibling;
  } else {
    vertices_[own.parent].first_child = own.next_sibling;
  }
  if (own.next_sibling >= 0) vertices_[own.next_sibling].previous_sibling = own.previous_sibling;
  own.parent = own.next_sibling = own.previous_sibling = -1;
}

void GraspTrees::reparent(int v, int parent, double length) {
  unlink(v);
  Vertex& own = vertices_[v];
  Vertex& above = vertices_[parent];
  own.parent = parent;
  own.next_sibling = above.first_child;
  if (above.first_child >= 0) vertices_[above.first_child].previous_sibling = v;
  above.first_child = v;
  const double change = above.cost + length - own.cost;
  stack_.assign(1, v);
  while (!stack_.empty()) {
    Vertex& below = vertices_[stack_.back()];
    stack_.pop_back();
    below.cost += change;
    for (int child = below.first_child; child >= 0; child = vertex(child).next_sibling) stack_.push_back(child);
  }
}

void GraspTrees::remove_leaf(int v) {
  unlink(v);
  Vertex& own = vertices_[v];
  own.alive = false;
  Tree& tree = trees_[own.tree];
  if (own.previous_in_tree >= 0) {
    vertices_[own.previous_in_tree].next_in_tree = own.next_in_tree;
  } else {
    tree.first = own.next_in_tree;
  }
  if (own.next_in_tree >= 0) vertices_[own.next_in_tree].previous_in_tree = own.previous_in_tree;
  --tree.size;
  int* link = &duplicates_[own.configuration];
  while (*link != v) link = &vertices_[*link].next_duplicate;
  *link = own.next_duplicate;
  --side_size_[side_of(own.tree)];
  if (v < indexed_) index_[side_of(own.tree)].remove(v);
}

const TreeIndex& GraspTrees::index(int side) const {
  for (; indexed_ < vertex_count(); ++indexed_)
    if (vertex(indexed_).alive) index_[side_of(vertex(indexed_).tree)].insert(indexed_, at(indexed_));
  return index_[side];
}

int GraspTrees::find(int tree, int configuration) const {
  int v = duplicates_[configuration];
  while (v >= 0 && vertex(v).tree != tree) v = vertex(v).next_duplicate;
  return v;
}

bool GraspTrees::has_duplicate(int v) const {
  return duplicates_[vertex(v).configuration] != v || vertex(v).next_duplicate >= 0;
}

double GraspTrees::distance(int a, int b) const {
  return std::sqrt(ends_.metric().squared_distance(configuration(a), configuration(b), static_cast<int>(dimension_)));
}

bool GraspTrees::is_scanned(int tree) const {
  const int size = tree_size(tree);
  return size <= kMaxScannedVertices || size < kScannedShare * side_size(side_of(tree));
}

int GraspTrees::nearest_in_tree(int tree, const double* q) const {
  double squared = kInfinity;
  if (!is_scanned(tree))
    return index(side_of(tree))
        .nearest(
            q, [&](int v) { return vertex(v).tree == tree; }, squared);
  int best = -1;
  each_in_tree(tree, [&](int v) {
    const double found = ends_.metric().squared_distance(at(v), q, static_cast<int>(dimension_));
    if (found >= squared) return;
    squared = found;
    best = v;
  });
  return best;
}

int GraspTrees::nearest_on_side(int side, const double* q) const {
  double squared;
  return index(side).nearest(
      q, [](int) { return true; }, squared);
}

void GraspTrees::near_in_tree(int tree, const double* q, double radius, std::vector<Near>& out) const {
  out.clear();
  if (!is_scanned(tree)) {
    index(side_of(tree)).within(q, radius, [&](int v, double squared) {
      if (vertex(v).tree == tree) out.push_back({v, std::sqrt(squared)});
    });
    return;
  }
  each_in_tree(tree, [&](int v) {
    const double squared = ends_.metric().squared_distance(at(v), q, static_cast<int>(dimension_));
    if (squared < radius * radius) out.push_back({v, std::sqrt(squared)});
  });
}

void GraspTrees::near_on_side(int side, const double* q, double radius, std::vector<Near>& out) const {
  out.clear();
  index(side).within(q, radius, [&](int v, double squared) { out.push_back({v, std::sqrt(squared)}); });
}

void GraspTrees::check_invariants() const {
  const auto demand = [](bool holds, const char* what) {
    if (!holds) throw std::logic_error(what);
  };
  std::vector<int> in_tree(trees_.size(), 0);
  std::size_t on_side[2] = {0, 0};
  for (int v = 0; v < vertex_count(); ++v) {
    const Vertex& own = vertex(v);
    if (!own.alive) continue;
    ++in_tree[own.tree];
    ++on_side[side_of(own.tree)];
    demand(find(own.tree, own.configuration) >= 0, "a vertex its configuration does not know");
    double squared;
    const int found = index(side_of(own.tree))
                          .nearest(
                              at(v), [&](int u) { return u == v; }, squared);
    demand(found == v && squared == 0, "a vertex the index does not know, or elsewhere");
    if (own.parent < 0) {
      demand(own.cost == 0, "a root with a cost");
      continue;
    }
    const Vertex& above = vertex(own.parent);
    demand(above.alive && above.tree == own.tree, "a parent that was removed or is of another tree");
    const double edge = std::sqrt(ends_.metric().squared_distance(at(v), at(own.parent), static_cast<int>(dimension_)));
    demand(std::abs(own.cost - above.cost - edge) < 1e-9, "a cost that is not the parent's and the edge's");
    int children = 0;
    for (int child = above.first_child; child >= 0; child = vertex(child).next_sibling) children += child == v ? 1 : 0;
    demand(children == 1, "a parent that does not have its child once");
    int steps = 0;
    for (int u = v; u >= 0; u = vertex(u).parent) demand(++steps <= vertex_count(), "a cycle");
  }
  for (std::size_t t = 0; t < trees_.size(); ++t) {
    int listed = 0;
    each_in_tree(static_cast<int>(t),
                 [&](int v) { listed += vertex(v).alive && vertex(v).tree == static_cast<int>(t); });
    demand(listed == in_tree[t] && trees_[t].size == listed, "a tree's list or size");
  }
  for (const int side : {0, 1})
    demand(index(side).size() == on_side[side] && static_cast<std::size_t>(side_size(side)) == on_side[side],
           "the index's size");
}

}  // namespace mmgrasp::detail
