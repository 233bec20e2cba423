#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/export.hpp"

namespace mmgrasp::detail {

/// Distances between configurations of which some values are angles without limits (JointGroup::wraps()): Euclidean,
/// those angles the short way round. It is the metric of the space in which whole turns of these values are the same
/// point, so the triangle inequality holds. Costs nothing where nothing wraps.
class MMGRASP_EXPORT JointMetric {
 public:
  JointMetric() = default;  ///< Nothing wraps.
  explicit JointMetric(const std::vector<bool>& wraps);

  bool any() const { return !wrapping_.empty(); }  ///< Something wraps.
  bool wraps(int i) const { return any() && wraps_[i] != 0; }
  /// The values that wrap, ascending.
  const std::vector<int>& wrapping() const { return wrapping_; }

  /// The angle equal to `to` up to whole turns that is nearest to `from`.
  static double nearest_angle(double from, double to) {
    return std::abs(to - from) <= kPi ? to : to - whole_turns(to - from);
  }
  /// Value i of the configuration equal to one with value `to` that is nearest to one with value `from`.
  double nearest(int i, double from, double to) const { return wraps(i) ? nearest_angle(from, to) : to; }
  /// The configuration equal to `to`, up to whole turns of the values that wrap, nearest to `from`: the end of the
  /// shortest edge between the two.
  Eigen::VectorXd nearest(const Eigen::VectorXd& from, const Eigen::VectorXd& to) const;

  /// Brings the values that wrap into [-pi, pi].
  void wrap(double* q) const {
    for (const int i : wrapping_) q[i] = shortest_turn(q[i]);
  }
  Eigen::VectorXd wrapped(const Eigen::VectorXd& q) const;

  double squared_distance(const double* a, const double* b, int dimension) const {
    if (any()) return squared_distance_around(a, b, dimension);
    double sum = 0;
    for (int i = 0; i < dimension; ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return sum;
  }
  double distance(const Eigen::Ref<const Eigen::VectorXd>& a, const Eigen::Ref<const Eigen::VectorXd>& b) const {
    return any() ? std::sqrt(squared_distance_around(a.data(), b.data(), static_cast<int>(a.size()))) : (a - b).norm();
  }

  /// Makes waypoints run on continuously: each becomes the nearest to the one before it. The first stays.
  void unroll(std::vector<Eigen::VectorXd>& waypoints) const;
  /// Adds waypoints on edges that turn an angle by more than half a turn: each edge is then the shortest one between
  /// its ends.
  void split_long_edges(std::vector<Eigen::VectorXd>& waypoints) const;

 private:
  double squared_distance_around(const double* a, const double* b, int dimension) const;

  std::vector<char> wraps_;  ///< Per value; empty when nothing wraps.
  std::vector<int> wrapping_;
};

}  // namespace mmgrasp::detail
