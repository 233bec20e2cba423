#pragma once

#include <Eigen/Core>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "plan/manipulation/common/grasp_candidates.hpp"

namespace mmgrasp::detail {

/// Arm configurations of many grasps at start and goal, packed for inner loops. Grasps are sorted by straight cost, so
/// that those that can still win are always the first ones.
class MMGRASP_EXPORT GraspEnds {
 public:
  static constexpr int kStart = 0, kGoal = 1;

  explicit GraspEnds(std::vector<GraspCandidate> candidates);

  int size() const { return static_cast<int>(candidates_.size()); }
  int dimension() const { return dimension_; }
  const JointMetric& metric() const { return metric_; }
  /// How many of the first grasps have a straight cost below this.
  int below(double cost) const;

  int grasp(int index) const { return candidates_[index].grasp; }
  int opening(int index) const { return candidates_[index].opening; }
  double cost(int index) const { return candidates_[index].cost; }
  /// Least cost any path with this grasp can have.
  double straight_cost(int index) const { return straight_[index]; }
  int count(int index, int side) const { return spans_[span(index, side)].count; }
  const double* end(int index, int side, int k) const {
    return values_.data() + (spans_[span(index, side)].first + k) * dimension_;
  }
  /// Distance to the nearest end on a side.
  double distance(int index, int side, const double* q) const;
  /// Least cost of a path with this grasp through `q`, over all its starts and goals. Its informed set (P2 5.2.3.1) is
  /// where this is below the cost to beat.
  double estimate(int index, const double* q) const;

 private:
  struct Span {
    int first, count;
  };
  static std::size_t span(int index, int side) { return 2 * index + side; }

  int dimension_;
  JointMetric metric_;
  std::vector<GraspCandidate> candidates_;
  std::vector<double> straight_;
  std::vector<Span> spans_;
  std::vector<double> values_;
};

}  // namespace mmgrasp::detail
