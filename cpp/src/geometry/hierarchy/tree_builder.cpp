#include "geometry/hierarchy/tree_builder.hpp"

#include <algorithm>
#include <array>
#include <limits>

namespace mmgrasp::detail {
namespace {

constexpr int kBins = 16;
constexpr int kFew = 48;  // so few that every cut is tried
// Given in the tree's coordinates, where the rounding of single precision is below 4e-7 for boxes and rays within them.
constexpr double kMargin = 2e-6;
constexpr int kDepthOfHalves = 24;  // deeper than that ranges are halved, which bounds the depth of any mesh's tree

int packets(int triangles) {
  return (triangles + kPacketWidth - 1) / kPacketWidth;
}

}  // namespace

TreeBuilder::Box::Box() {
  std::fill(lower, lower + 3, std::numeric_limits<float>::infinity());
  std::fill(upper, upper + 3, -std::numeric_limits<float>::infinity());
}

void TreeBuilder::Box::extend(const Box& other) {
  for (int k = 0; k < 3; ++k) {
    lower[k] = std::min(lower[k], other.lower[k]);
    upper[k] = std::max(upper[k], other.upper[k]);
  }
}

float TreeBuilder::Box::area() const {
  const float x = upper[0] - lower[0], y = upper[1] - lower[1], z = upper[2] - lower[2];
  return x * y + y * z + z * x;
}

TreeBuilder::TreeBuilder(TriangleTree& tree, const TriangleMesh& mesh) : tree_(tree), mesh_(mesh) {
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    Eigen::AlignedBox3d box;
    for (const int corner : mesh.triangles[i]) box.extend((mesh.vertices[corner] - tree.centre_) * tree.scale_);
    Item item;
    for (int k = 0; k < 3; ++k) {
      item.box.lower[k] = static_cast<float>(box.min()[k] - kMargin);
      item.box.upper[k] = static_cast<float>(box.max()[k] + kMargin);
    }
    item.triangle = static_cast<int>(i);
    items_.push_back(item);
  }
  if (!items_.empty()) build(range(0, static_cast<int>(items_.size())), 0);
}

TreeBuilder::Range TreeBuilder::range(int begin, int end) const {
  Range out{begin, end, {}};
  for (int i = begin; i < end; ++i) out.box.extend(items_[i].box);
  return out;
}

// Where the second part begins, after sorting the items of the range into the two parts: of the cuts between bins along
// each axis the one with the least sum of area times packets.
int TreeBuilder::best_split(const Range& range) {
  if (range.count() <= kFew) return best_split_of_few(range);
  struct Bin {
    Box box;
    int count = 0;
  };
  float best_cost = std::numeric_limits<float>::infinity(), best_low = 0, best_scale = 0;
  int best_axis = -1, best_bin = 0;
  const auto bin_of = [](float middle, float low, float scale) {
    return std::min(kBins - 1, static_cast<int>((middle - low) * scale));
  };
  for (int axis = 0; axis < 3; ++axis) {
    float low = items_[range.begin].middle(axis), high = low;
    for (int i = range.begin; i < range.end; ++i) {
      low = std::min(low, items_[i].middle(axis));
      high = std::max(high, items_[i].middle(axis));
    }
    if (!(high - low > 1e-6f)) continue;
    const float scale = kBins / (high - low);
    std::array<Bin, kBins> bins;
    for (int i = range.begin; i < range.end; ++i) {
      Bin& bin = bins[bin_of(items_[i].middle(axis), low, scale)];
      bin.box.extend(items_[i].box);
      ++bin.count;
    }
    std::array<float, kBins> right_cost{};
    Bin sum;
    for (int b = kBins - 1; b > 0; --b) {
      sum.box.extend(bins[b].box);
      sum.count += bins[b].count;
      right_cost[b] = sum.count > 0 ? sum.box.area() * static_cast<float>(packets(sum.count)) : 0;
    }
    sum = {};
    for (int b = 1; b < kBins; ++b) {
      sum.box.extend(bins[b - 1].box);
      sum.count += bins[b - 1].count;
      if (sum.count == 0 || sum.count == range.count()) continue;
      const float cost = sum.box.area() * static_cast<float>(packets(sum.count)) + right_cost[b];
      if (cost < best_cost) {
        best_cost = cost;
        best_axis = axis;
        best_bin = b;
        best_low = low;
        best_scale = scale;
      }
    }
  }
  if (best_axis < 0) return range.begin + range.count() / 2;  // all middles coincide
  const auto middle = std::partition(items_.begin() + range.begin, items_.begin() + range.end, [&](const Item& item) {
    return bin_of(item.middle(best_axis), best_low, best_scale) < best_bin;
  });
  return static_cast<int>(middle - items_.begin());
}

// The same with a cut at every item.
int TreeBuilder::best_split_of_few(const Range& range) {
  const auto begin = items_.begin() + range.begin, end = items_.begin() + range.end;
  const auto sort_along = [&](int axis) {
    std::sort(begin, end, [axis](const Item& a, const Item& b) {
      return a.middle(axis) != b.middle(axis) ? a.middle(axis) < b.middle(axis) : a.triangle < b.triangle;
    });
  };
  float best_cost = std::numeric_limits<float>::infinity();
  int best_axis = 0, best_left = range.count() / 2;
  for (int axis = 0; axis < 3; ++axis) {
    sort_along(axis);
    std::array<float, kFew> left_cost;
    Box box;
    for (int i = 1; i < range.count(); ++i) {
      box.extend(begin[i - 1].box);
      left_cost[i] = box.area() * static_cast<float>(packets(i));
    }
    box = {};
    for (int i = range.count() - 1; i > 0; --i) {
      box.extend(begin[i].box);
      const float cost = left_cost[i] + box.area() * static_cast<float>(packets(range.count() - i));
      if (cost >= best_cost) continue;
      best_cost = cost;
      best_axis = axis;
      best_left = i;
    }
  }
  sort_along(best_axis);
  return range.begin + best_left;
}

int TreeBuilder::add_packet(const Range& range) {
  TrianglePacket packet;
  for (int lane = 0; lane < kPacketWidth; ++lane) {
    const bool filled = lane < range.count();
    const int triangle = items_[range.begin + (filled ? lane : 0)].triangle;
    packet.triangle[lane] = filled ? triangle : -1;
    for (int c = 0; c < 3; ++c) {
      const Eigen::Vector3d& corner = mesh_.vertices[mesh_.triangles[triangle][filled ? c : 0]];
      for (int k = 0; k < 3; ++k) packet.corner[c][k][lane] = corner[k];
    }
  }
  tree_.packets_.push_back(packet);
  return ~static_cast<int>(tree_.packets_.size() - 1);
}

int TreeBuilder::build(const Range& whole, int depth) {
  poll_();
  std::vector<Range> parts{whole};
  while (parts.size() < kTreeWidth) {
    int widest = -1;
    for (int i = 0; i < static_cast<int>(parts.size()); ++i) {
      if (parts[i].count() <= kPacketWidth) continue;
      const bool wider = widest < 0 || (depth > kDepthOfHalves ? parts[i].count() > parts[widest].count()
                                                               : parts[i].box.area() > parts[widest].box.area());
      if (wider) widest = i;
    }
    if (widest < 0) break;
    const Range part = parts[widest];
    const int middle = depth > kDepthOfHalves ? part.begin + part.count() / 2 : best_split(part);
    parts[widest] = range(part.begin, middle);
    parts.push_back(range(middle, part.end));
  }
  const int index = static_cast<int>(tree_.nodes_.size());
  tree_.nodes_.emplace_back();
  TreeNode node;
  for (int i = 0; i < kTreeWidth; ++i) {
    const bool filled = i < static_cast<int>(parts.size());
    const Box box = filled ? parts[i].box : Box();
    for (int k = 0; k < 3; ++k) {
      node.bounds[k][i] = box.lower[k];
      node.bounds[3 + k][i] = box.upper[k];
    }
    node.child[i] = 0;
    if (filled) node.child[i] = parts[i].count() <= kPacketWidth ? add_packet(parts[i]) : build(parts[i], depth + 1);
  }
  tree_.nodes_[index] = node;
  return index;
}

}  // namespace mmgrasp::detail
