#include "plan/manipulation/common/grasp_ends.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {

GraspEnds::GraspEnds(std::vector<GraspCandidate> candidates)
    : dimension_(static_cast<int>(candidates.front().starts.front().size())), metric_(candidates.front().metric) {
  std::vector<double> straight;
  for (const GraspCandidate& candidate : candidates) straight.push_back(candidate.straight_cost());
  std::vector<std::size_t> order(candidates.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return straight[a] < straight[b]; });
  for (const std::size_t i : order) {
    straight_.push_back(straight[i]);
    candidates_.push_back(std::move(candidates[i]));
    for (const auto* side : {&candidates_.back().starts, &candidates_.back().goals}) {
      spans_.push_back({static_cast<int>(values_.size()) / dimension_, static_cast<int>(side->size())});
      for (const Eigen::VectorXd& q : *side) values_.insert(values_.end(), q.data(), q.data() + dimension_);
    }
  }
}

int GraspEnds::below(double cost) const {
  return static_cast<int>(std::lower_bound(straight_.begin(), straight_.end(), cost) - straight_.begin());
}

double GraspEnds::distance(int index, int side, const double* q) const {
  const Span& own = spans_[span(index, side)];
  const double* value = values_.data() + own.first * dimension_;
  double least = kInfinity;
  for (int k = 0; k < own.count; ++k, value += dimension_)
    least = std::min(least, metric_.squared_distance(value, q, dimension_));
  return std::sqrt(least);
}

double GraspEnds::estimate(int index, const double* q) const {
  return cost(index) + distance(index, kStart, q) + distance(index, kGoal, q);
}

}  // namespace mmgrasp::detail
