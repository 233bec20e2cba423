#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/export.hpp"

namespace mmgrasp::detail {

/// Nearest-neighbour search over the vertices of any number of trees: one k-d tree with small buckets that grows and
/// shrinks with them. Each query says which vertices count.
class MMGRASP_EXPORT TreeIndex {
 public:
  explicit TreeIndex(int dimension);

  /// `id` >= 0, not in the index.
  void insert(int id, const double* q);
  void remove(int id);
  std::size_t size() const { return size_; }

  /// The nearest of those for which take(id) holds, or -1; `squared` is its distance.
  template <class Take>
  int nearest(const double* q, const Take& take, double& squared) const {
    int best = -1;
    squared = kInfinity;
    search(q, squared, [&](int id, double found) {
      if (found >= squared || !take(id)) return;
      squared = found;
      best = id;
    });
    return best;
  }

  /// Calls visit(id, squared distance) for all nearer than `radius`.
  template <class Visit>
  void within(const double* q, double radius, const Visit& visit) const {
    const double bound = radius * radius;
    search(q, bound, [&](int id, double found) {
      if (found < bound) visit(id, found);
    });
  }

 private:
  static constexpr int kBlock = 16;

  struct Node {
    double split = 0;
    int axis = -1;  ///< -1: a leaf.
    int low = -1;   ///< Child, or the leaf's first block.
    int high = -1;
  };
  struct Block {
    std::array<int, kBlock> ids;
    int count = 0;
    int next = -1;  ///< Another block of the same leaf, which then holds one point many times.
  };
  struct Place {
    int block = -1, slot = 0;
  };

  double* coordinates(int block) { return values_.data() + static_cast<std::size_t>(block) * block_size_; }
  const double* coordinates(int block) const { return values_.data() + static_cast<std::size_t>(block) * block_size_; }
  int new_block();
  void put(int block, int id, const double* q);
  void split(int node);

  /// Visits cells from the root down, nearer child first; `bound` may decrease meanwhile.
  template <class Visit>
  void search(const double* q, const double& bound, const Visit& visit) const {
    visit_node(0, q, 0, bound, visit);
  }

  template <class Visit>
  void visit_node(int index, const double* q, double cell, const double& bound, const Visit& visit) const {
    const Node& node = nodes_[index];
    if (node.axis < 0) {
      for (int b = node.low; b >= 0; b = blocks_[b].next) visit_block(b, q, visit);
      return;
    }
    const double across = q[node.axis] - node.split;
    const int near = across < 0 ? node.low : node.high, far = across < 0 ? node.high : node.low;
    visit_node(near, q, cell, bound, visit);
    // Only this axis' part of the far cell's distance grows.
    double& offset = offsets_[node.axis];
    const double before = offset, farther = cell - before * before + across * across;
    if (farther >= bound) return;
    offset = across;
    visit_node(far, q, farther, bound, visit);
    offset = before;
  }

  template <class Visit>
  void visit_block(int index, const double* q, const Visit& visit) const {
    const Block& block = blocks_[index];
    const double* values = coordinates(index);
    double squared[kBlock] = {};
    for (int axis = 0; axis < dimension_; ++axis, values += kBlock)
      for (int i = 0; i < kBlock; ++i) squared[i] += (values[i] - q[axis]) * (values[i] - q[axis]);
    for (int i = 0; i < block.count; ++i) visit(block.ids[i], squared[i]);
  }

  int dimension_;
  std::size_t block_size_;
  std::size_t size_ = 0;
  std::vector<Node> nodes_;
  std::vector<Block> blocks_;
  std::vector<double> values_;           ///< Coordinates per block, one axis after the other.
  std::vector<Place> places_;            ///< Per id.
  mutable std::vector<double> offsets_;  ///< Scratch: zero between searches.
};

}  // namespace mmgrasp::detail
