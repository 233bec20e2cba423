#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/export.hpp"

namespace mmgrasp::detail {

/// Distances between configurations: Euclidean over joint values times their weights, of which some may be angles
/// without limits (JointGroup::wraps()) that count the short way round. It is the metric of the space in which whole
/// turns of these values are the same point, so the triangle inequality holds. Costs nothing where nothing wraps and
/// all weights are 1.
///
/// What stores configurations to search among them stores their coordinates: joint values times weights, in which the
/// metric is Euclidean but for turn(i), after which value i begins anew.
class MMGRASP_EXPORT JointMetric {
 public:
  JointMetric() = default;  ///< Nothing wraps, all weights are 1.
  /// `weights`: > 0, or empty where all are 1 (JointWeights::of()).
  explicit JointMetric(const std::vector<bool>& wraps, Eigen::VectorXd weights = {});

  bool any() const { return !wrapping_.empty(); }  ///< Something wraps.
  bool weighted() const { return weights_.size() > 0; }
  bool plain() const { return !any() && !weighted(); }
  double weight(int i) const { return weighted() ? weights_[i] : 1; }
  const Eigen::VectorXd& weights() const { return weights_; }  ///< Empty where all are 1.
  /// What counts as 1 rad or m where a length is meant in all joints alike: the root mean square of the weights.
  double unit() const { return unit_; }
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

  /// A whole turn of value i in coordinates.
  double turn(int i) const { return weight(i) * kTwoPi; }
  /// Coordinates of q, those that wrap within half a turn either way. `q` and `out` may be the same.
  void to_coordinates(const double* q, double* out, int dimension) const {
    for (int i = 0; i < dimension; ++i) out[i] = weight(i) * (wraps(i) ? shortest_turn(q[i]) : q[i]);
  }
  /// The configuration of coordinates in any turn.
  void from_coordinates(const double* coordinates, double* out, int dimension) const {
    for (int i = 0; i < dimension; ++i) out[i] = coordinates[i] / weight(i);
  }

  /// Length of a straight motion, which may turn angles by more than half a turn.
  double norm(const Eigen::Ref<const Eigen::VectorXd>& motion) const {
    return weighted() ? motion.cwiseProduct(weights_).norm() : motion.norm();
  }
  /// Length of a path whose values run on continuously.
  double length(const std::vector<Eigen::VectorXd>& waypoints) const;

  double squared_distance(const double* a, const double* b, int dimension) const {
    if (!plain()) return squared_distance_around(a, b, dimension);
    double sum = 0;
    for (int i = 0; i < dimension; ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return sum;
  }
  double squared_distance(const Eigen::Ref<const Eigen::VectorXd>& a,
                          const Eigen::Ref<const Eigen::VectorXd>& b) const {
    if (any()) return squared_distance_around(a.data(), b.data(), static_cast<int>(a.size()));
    return weighted() ? (a - b).cwiseProduct(weights_).squaredNorm() : (a - b).squaredNorm();
  }
  double distance(const Eigen::Ref<const Eigen::VectorXd>& a, const Eigen::Ref<const Eigen::VectorXd>& b) const {
    return std::sqrt(squared_distance(a, b));
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
  Eigen::VectorXd weights_;  ///< Empty when all are 1.
  double unit_ = 1;
};

}  // namespace mmgrasp::detail
