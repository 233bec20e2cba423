#include "collision/narrow/box_tree.hpp"
#include "mmgrasp/core/detail/interruption.hpp"

#include <algorithm>
#include <numeric>

namespace mmgrasp::detail {

BoxTree::BoxTree(const std::vector<Eigen::AlignedBox3d>& boxes, int leaf_size) {
  if (boxes.empty()) return;
  items_.resize(boxes.size());
  std::iota(items_.begin(), items_.end(), 0);
  nodes_.reserve(2 * boxes.size());
  nodes_.emplace_back();
  build(0, 0, static_cast<int>(boxes.size()), leaf_size, boxes);
}

// Halves at the median along the longest side of the centres' bounds: depth stays at log2 of the count.
void BoxTree::build(int node, int begin, int end, int leaf_size, const std::vector<Eigen::AlignedBox3d>& boxes) {
  if (end - begin > 1000) throw_if_interrupted();
  Eigen::AlignedBox3d bounds, centres;
  for (int i = begin; i < end; ++i) {
    bounds.extend(boxes[items_[i]]);
    centres.extend(boxes[items_[i]].center());
  }
  nodes_[node].centre = bounds.center();
  nodes_[node].half = 0.5 * bounds.sizes();
  if (end - begin <= leaf_size) {
    nodes_[node].first = begin;
    nodes_[node].count = end - begin;
    return;
  }
  int axis = 0;
  centres.sizes().maxCoeff(&axis);
  const int middle = (begin + end) / 2;
  std::nth_element(items_.begin() + begin, items_.begin() + middle, items_.begin() + end, [&](int a, int b) {
    const double ca = boxes[a].center()[axis], cb = boxes[b].center()[axis];
    return ca != cb ? ca < cb : a < b;
  });
  const int left = static_cast<int>(nodes_.size());
  nodes_[node].first = left;
  nodes_.emplace_back();
  nodes_.emplace_back();
  build(left, begin, middle, leaf_size, boxes);
  build(left + 1, middle, end, leaf_size, boxes);
}

}  // namespace mmgrasp::detail
