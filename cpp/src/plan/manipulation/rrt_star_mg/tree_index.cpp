#include "plan/manipulation/rrt_star_mg/tree_index.hpp"

#include <algorithm>
#include <utility>

namespace mmgrasp::detail {

TreeIndex::TreeIndex(int dimension, JointMetric metric)
    : dimension_(dimension), metric_(std::move(metric)), block_size_(dimension * kBlock), offsets_(dimension, 0.0) {
  nodes_.emplace_back();
  nodes_.back().low = new_block();
}

int TreeIndex::new_block() {
  blocks_.emplace_back();
  values_.resize(values_.size() + block_size_, 0.0);
  return static_cast<int>(blocks_.size()) - 1;
}

void TreeIndex::put(int block, int id, const double* q) {
  Block& own = blocks_[block];
  double* values = coordinates(block);
  for (int axis = 0; axis < dimension_; ++axis) values[axis * kBlock + own.count] = q[axis];
  own.ids[own.count] = id;
  if (static_cast<std::size_t>(id) >= places_.size()) places_.resize(id + 1);
  places_[id] = {block, own.count++};
}

void TreeIndex::insert(int id, const double* q) {
  if (metric_.plain()) return insert_coordinates(id, q);
  std::vector<double> coordinates(dimension_);
  metric_.to_coordinates(q, coordinates.data(), dimension_);
  insert_coordinates(id, coordinates.data());
}

void TreeIndex::insert_coordinates(int id, const double* q) {
  ++size_;
  for (;;) {
    std::size_t at = 0;
    while (nodes_[at].axis >= 0) at = q[nodes_[at].axis] < nodes_[at].split ? nodes_[at].low : nodes_[at].high;
    for (int b = nodes_[at].low; b >= 0; b = blocks_[b].next) {
      if (blocks_[b].count == kBlock) continue;
      put(b, id, q);
      return;
    }
    split(static_cast<int>(at));
  }
}

void TreeIndex::split(int index) {
  const int first = nodes_[index].low;
  const double* values = coordinates(first);
  int axis = 0;
  double widest = -1;
  for (int a = 0; a < dimension_; ++a) {
    const auto [least, most] = std::minmax_element(values + a * kBlock, values + (a + 1) * kBlock);
    if (*most - *least > widest) {
      widest = *most - *least;
      axis = a;
    }
  }
  if (!(widest > 0)) {
    // All the same point (only then can a leaf have had several blocks): another block behind the first.
    const int added = new_block();
    blocks_[added].next = blocks_[first].next;
    blocks_[first].next = added;
    return;
  }
  std::array<double, kBlock> sorted;
  std::copy(values + axis * kBlock, values + (axis + 1) * kBlock, sorted.begin());
  std::sort(sorted.begin(), sorted.end());
  // The middle, or the next larger value when all below are the same: both sides get something.
  const double middle = *std::upper_bound(sorted.begin(), sorted.end(), sorted.front()) > sorted[kBlock / 2]
                            ? *std::upper_bound(sorted.begin(), sorted.end(), sorted.front())
                            : sorted[kBlock / 2];
  std::vector<int> chain;
  for (int b = first; b >= 0; b = blocks_[b].next) chain.push_back(b);
  const int low = static_cast<int>(nodes_.size());
  nodes_.resize(nodes_.size() + 2);
  for (const int child : {low, low + 1}) nodes_[child].low = new_block();
  Node& node = nodes_[index];
  node.axis = axis;
  node.split = middle;
  node.low = low;
  node.high = low + 1;
  std::vector<double> q(dimension_);
  for (const int b : chain) {
    const Block block = blocks_[b];
    for (int i = 0; i < block.count; ++i) {
      for (int a = 0; a < dimension_; ++a) q[a] = coordinates(b)[a * kBlock + i];
      --size_;
      insert_coordinates(block.ids[i], q.data());
    }
    blocks_[b].count = 0;
  }
}

void TreeIndex::remove(int id) {
  const Place place = places_[id];
  Block& block = blocks_[place.block];
  const int last = --block.count;
  double* values = coordinates(place.block);
  for (int axis = 0; axis < dimension_; ++axis) values[axis * kBlock + place.slot] = values[axis * kBlock + last];
  block.ids[place.slot] = block.ids[last];
  places_[block.ids[place.slot]].slot = place.slot;
  --size_;
}

}  // namespace mmgrasp::detail
