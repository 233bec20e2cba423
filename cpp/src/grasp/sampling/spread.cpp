#include "grasp/sampling/spread.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {

Eigen::Matrix3d align_axes(const Eigen::Vector3d& from_a, const Eigen::Vector3d& from_b, const Eigen::Vector3d& to_a,
                           const Eigen::Vector3d& to_b) {
  Eigen::Matrix3d from, to;
  from << from_a, from_b, from_a.cross(from_b);
  to << to_a, to_b, to_a.cross(to_b);
  return to * from.transpose();
}

int direction_bin(const Eigen::Vector3d& direction) {
  const double threshold = std::sin(kPi / 8);  // half way between a face middle and an edge middle
  int bin = 0;
  for (int i = 0; i < 3; ++i) bin = 3 * bin + (direction[i] > threshold ? 2 : direction[i] < -threshold ? 0 : 1);
  return bin;
}

std::vector<std::size_t> keep_spread(const std::vector<RankedCandidate>& candidates, int most) {
  std::vector<std::size_t> order(candidates.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return candidates[a].quality > candidates[b].quality; });
  throw_if_interrupted();
  std::map<int, int> seen;
  std::vector<int> rank(candidates.size());  // place of a candidate among those of its bin
  for (const std::size_t i : order) rank[i] = seen[candidates[i].bin]++;

  std::vector<std::size_t> kept = std::move(order);
  std::stable_sort(kept.begin(), kept.end(), [&](std::size_t a, std::size_t b) { return rank[a] < rank[b]; });
  throw_if_interrupted();
  kept.resize(std::min<std::size_t>(kept.size(), most));
  std::sort(kept.begin(), kept.end(), [&](std::size_t a, std::size_t b) {
    const double qa = candidates[a].quality, qb = candidates[b].quality;
    return qa != qb ? qa > qb : a < b;
  });
  return kept;
}

}  // namespace mmgrasp::detail
