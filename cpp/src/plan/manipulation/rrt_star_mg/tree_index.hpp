#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/export.hpp"
#include "mmgrasp/robot/detail/joint_metric.hpp"

namespace mmgrasp::detail {

/// Nearest-neighbour search over the vertices of any number of trees: one k-d tree with small buckets that grows and
/// shrinks with them. It holds the metric's coordinates, so distances are the metric's. Each query says which vertices
/// count.
class MMGRASP_EXPORT TreeIndex {
 public:
  explicit TreeIndex(int dimension, JointMetric metric = {});

  /// `id` >= 0, not in the index. Angles that wrap may be given in any turn, in queries too.
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

  double* coordinates(int block) { return values_.data() + block * block_size_; }
  const double* coordinates(int block) const { return values_.data() + block * block_size_; }
  int new_block();
  void insert_coordinates(int id, const double* q);
  void put(int block, int id, const double* q);
  void split(int node);

  /// Visits cells from the root down, nearer child first; `bound` may decrease meanwhile.
  template <class Visit>
  void search(const double* q, const double& bound, const Visit& visit) const {
    if (metric_.plain()) return visit_node(0, q, 0, bound, visit);
    query_.resize(dimension_);
    metric_.to_coordinates(q, query_.data(), dimension_);
    if (!metric_.any()) return visit_node(0, query_.data(), 0, bound, visit);
    cell_low_.resize(dimension_);
    cell_high_.resize(dimension_);
    for (const int i : metric_.wrapping()) {
      cell_high_[i] = 0.5 * metric_.turn(i);
      cell_low_[i] = -cell_high_[i];
    }
    visit_node_around(0, query_.data(), 0, bound, visit);
  }

  /// Does what visit_node() does where angles wrap: a cell may be nearer across the seam than across the plane that cut
  /// it off.
  template <class Visit>
  void visit_node_around(int index, const double* q, double cell, const double& bound, const Visit& visit) const {
    const Node& node = nodes_[index];
    if (node.axis < 0) return visit_leaf(node, q, visit);
    if (!metric_.wraps(node.axis)) {
      const double across = q[node.axis] - node.split;
      const bool below = across < 0;
      visit_node_around(below ? node.low : node.high, q, cell, bound, visit);
      return visit_far(below ? node.high : node.low, node.axis, across, q, cell, bound, visit);
    }
    const double low = cell_low_[node.axis], high = cell_high_[node.axis];
    const double turn = metric_.turn(node.axis);
    const double to_low = off(q[node.axis], low, node.split, turn), to_high = off(q[node.axis], node.split, high, turn);
    for (const bool lower : {to_low <= to_high, to_low > to_high}) {
      (lower ? cell_high_ : cell_low_)[node.axis] = node.split;
      visit_far(lower ? node.low : node.high, node.axis, lower ? to_low : to_high, q, cell, bound, visit);
      (lower ? cell_high_ : cell_low_)[node.axis] = lower ? high : low;
    }
  }

  /// Visits a child that is `across` away along its parent's axis, if that is near enough.
  template <class Visit>
  void visit_far(int child, int axis, double across, const double* q, double cell, const double& bound,
                 const Visit& visit) const {
    double& offset = offsets_[axis];
    const double before = offset, farther = cell - before * before + across * across;
    if (farther >= bound) return;
    offset = across;
    visit_node_around(child, q, farther, bound, visit);
    offsets_[axis] = before;
  }

  /// Distance of an angle from an interval of angles, all of them within half a turn of 0.
  static double off(double angle, double low, double high, double turn) {
    if (angle >= low && angle <= high) return 0;
    return angle < low ? std::min(low - angle, angle + turn - high) : std::min(angle - high, low + turn - angle);
  }

  template <class Visit>
  void visit_node(int index, const double* q, double cell, const double& bound, const Visit& visit) const {
    const Node& node = nodes_[index];
    if (node.axis < 0) return visit_leaf(node, q, visit);
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
  void visit_leaf(const Node& leaf, const double* q, const Visit& visit) const {
    for (int b = leaf.low; b >= 0; b = blocks_[b].next) visit_block(b, q, visit);
  }

  template <class Visit>
  void visit_block(int index, const double* q, const Visit& visit) const {
    const Block& block = blocks_[index];
    const double* values = coordinates(index);
    double squared[kBlock] = {};
    for (int axis = 0; axis < dimension_; ++axis, values += kBlock) {
      if (metric_.wraps(axis)) {
        const double turn = metric_.turn(axis);
        for (int i = 0; i < kBlock; ++i) {
          const double apart = std::abs(values[i] - q[axis]), least = std::min(apart, std::abs(turn - apart));
          squared[i] += least * least;
        }
      } else {
        for (int i = 0; i < kBlock; ++i) squared[i] += (values[i] - q[axis]) * (values[i] - q[axis]);
      }
    }
    for (int i = 0; i < block.count; ++i) visit(block.ids[i], squared[i]);
  }

  int dimension_;
  JointMetric metric_;
  std::size_t block_size_;
  std::size_t size_ = 0;
  std::vector<Node> nodes_;
  std::vector<Block> blocks_;
  std::vector<double> values_;                                ///< Coordinates per block, one axis after the other.
  std::vector<Place> places_;                                 ///< Per id.
  mutable std::vector<double> offsets_;                       ///< Scratch: zero between searches.
  mutable std::vector<double> query_, cell_low_, cell_high_;  ///< Scratch where the metric is not plain.
};

}  // namespace mmgrasp::detail
