#pragma once

#include <Eigen/Geometry>
#include <vector>

namespace mmgrasp::detail {

/// Binary tree of axis-aligned boxes over numbered items. Immutable.
class BoxTree {
 public:
  struct Node {
    Eigen::Vector3d centre, half;
    int first = 0;  ///< Leaf: first position in items(). Inner node: left child; the right one is next to it.
    int count = 0;  ///< Items of a leaf; 0 for inner nodes.
  };

  BoxTree() = default;
  BoxTree(const std::vector<Eigen::AlignedBox3d>& boxes, int leaf_size);

  bool empty() const { return nodes_.empty(); }
  const std::vector<Node>& nodes() const { return nodes_; }
  const std::vector<int>& items() const { return items_; }

  /// Calls visit(item) for items whose leaf meets the box until one returns true; true then.
  template <class Visit>
  bool any_in(const Eigen::Vector3d& centre, const Eigen::Vector3d& half, const Visit& visit) const {
    if (nodes_.empty()) return false;
    int stack[64];
    int size = 0;
    stack[size++] = 0;
    while (size > 0) {
      const Node& node = nodes_[stack[--size]];
      if (((node.centre - centre).cwiseAbs() - node.half - half).maxCoeff() > 0) continue;
      if (node.count == 0) {
        stack[size++] = node.first + 1;
        stack[size++] = node.first;
        continue;
      }
      for (int i = 0; i < node.count; ++i) {
        if (visit(items_[node.first + i])) return true;
      }
    }
    return false;
  }

 private:
  void build(int node, int begin, int end, int leaf_size, const std::vector<Eigen::AlignedBox3d>& boxes);
  std::vector<Node> nodes_;
  std::vector<int> items_;
};

}  // namespace mmgrasp::detail
