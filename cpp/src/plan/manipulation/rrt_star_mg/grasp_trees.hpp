#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "plan/manipulation/common/grasp_ends.hpp"
#include "plan/manipulation/rrt_star_mg/tree_index.hpp"

namespace mmgrasp::detail {

/// The trees of RRT*-MG (P2 5.3): for each grasp one that grows from its starts and one that grows from its goals, each
/// with as many roots as there are arm configurations at that end. Vertices of all trees of a side share one
/// nearest-neighbour structure and know the number of their tree. Configurations are kept apart from vertices, so that
/// a vertex can be duplicated into another tree (P2 5.3.2) and what is known of a configuration is known to all.
/// Numbers of vertices and configurations are never used again.
class MMGRASP_EXPORT GraspTrees {
 public:
  struct Vertex {
    int configuration;
    int tree;
    int parent;       ///< -1: a root.
    double cost;      ///< Length of the branch from its root.
    double estimate;  ///< GraspEnds::estimate: no path with this grasp through here costs less.
    int first_child = -1, next_sibling = -1, previous_sibling = -1;
    int next_in_tree = -1, previous_in_tree = -1;
    int next_duplicate = -1;  ///< Another vertex with the same configuration.
    bool alive = true;
  };
  struct Near {
    int vertex;
    double distance;
    double key = 0;  ///< What the caller sorts by.
  };

  explicit GraspTrees(const GraspEnds& ends);

  const GraspEnds& ends() const { return ends_; }
  static int tree(int grasp, int side) { return 2 * grasp + side; }
  static int grasp_of(int tree) { return tree / 2; }
  static int side_of(int tree) { return tree % 2; }
  const Vertex& vertex(int v) const { return vertices_[v]; }
  int vertex_count() const { return static_cast<int>(vertices_.size()); }  ///< Removed ones included.
  int tree_size(int tree) const { return trees_[tree].size; }
  int side_size(int side) const { return side_size_[side]; }
  int configuration_count() const { return static_cast<int>(duplicates_.size()); }
  const double* configuration(int c) const { return values_.data() + static_cast<std::size_t>(c) * dimension_; }
  const double* at(int v) const { return configuration(vertex(v).configuration); }
  /// A vertex of the tree with this configuration, or -1.
  int find(int tree, int configuration) const;
  /// Another vertex has the same configuration.
  bool has_duplicate(int v) const;
  /// Distance of two configurations by the ends' metric, and of two vertices.
  double distance(int a, int b) const;
  double vertex_distance(int a, int b) const { return distance(vertex(a).configuration, vertex(b).configuration); }

  int add_configuration(const double* q);
  /// A new vertex below `parent`, `length` away.
  int add(int parent, int configuration, double length);
  /// Hangs `v` below another vertex of its tree that is not below `v`; costs below follow.
  void reparent(int v, int parent, double length);
  /// Removes a vertex without children.
  void remove_leaf(int v);
  /// Removes a vertex and all below it; calls on_remove(vertex) before each is removed.
  template <class OnRemove>
  void remove_below(int v, const OnRemove& on_remove) {
    while (vertex(v).first_child >= 0) remove_below(vertex(v).first_child, on_remove);
    on_remove(v);
    remove_leaf(v);
  }
  template <class Visit>
  void each_in_tree(int tree, const Visit& visit) const {
    for (int v = trees_[tree].first; v >= 0;) {
      const int next = vertex(v).next_in_tree;
      visit(v);
      v = next;
    }
  }

  /// The nearest vertex of one tree (never -1: trees keep their roots), and of all trees of a side.
  int nearest_in_tree(int tree, const double* q) const;
  int nearest_on_side(int side, const double* q) const;
  /// Vertices nearer than `radius`; `out` is overwritten.
  void near_in_tree(int tree, const double* q, double radius, std::vector<Near>& out) const;
  void near_on_side(int side, const double* q, double radius, std::vector<Near>& out) const;

  /// Throws std::logic_error unless all invariants hold: each cost is the parent's plus the edge's length, every vertex
  /// hangs below a root of its own tree, lists and counts hold exactly the living ones. For tests.
  void check_invariants() const;

 private:
  struct Tree {
    int first = -1;
    int size = 0;
  };

  int create(int tree, int parent, int configuration, double cost);
  void unlink(int v);
  /// Small trees are faster to scan than to find among all the others.
  bool is_scanned(int tree) const;
  /// The index of a side with all vertices. They are inserted when it is first queried: many problems end before.
  const TreeIndex& index(int side) const;

  const GraspEnds& ends_;
  std::size_t dimension_;
  std::vector<double> values_;   ///< Configurations.
  std::vector<int> duplicates_;  ///< Per configuration: its vertex made last, or -1; the others follow.
  std::vector<Vertex> vertices_;
  std::vector<Tree> trees_;
  int side_size_[2] = {0, 0};
  mutable TreeIndex index_[2];  ///< Per side.
  mutable int indexed_ = 0;     ///< Vertices before this one are in their index, or were removed.
  std::vector<int> stack_;
};

}  // namespace mmgrasp::detail
