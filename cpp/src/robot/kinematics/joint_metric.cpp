#include "mmgrasp/robot/detail/joint_metric.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace mmgrasp::detail {

JointMetric::JointMetric(const std::vector<bool>& wraps, Eigen::VectorXd weights) : weights_(std::move(weights)) {
  for (std::size_t i = 0; i < wraps.size(); ++i)
    if (wraps[i]) wrapping_.push_back(static_cast<int>(i));
  if (any()) wraps_.assign(wraps.begin(), wraps.end());
  if (weighted()) unit_ = std::sqrt(weights_.squaredNorm() / static_cast<double>(weights_.size()));
}

double JointMetric::length(const std::vector<Eigen::VectorXd>& waypoints) const {
  double sum = 0;
  for (std::size_t w = 1; w < waypoints.size(); ++w) sum += norm(waypoints[w] - waypoints[w - 1]);
  return sum;
}

Eigen::VectorXd JointMetric::nearest(const Eigen::VectorXd& from, const Eigen::VectorXd& to) const {
  Eigen::VectorXd result = to;
  for (const int i : wrapping_) result[i] = nearest_angle(from[i], to[i]);
  return result;
}

Eigen::VectorXd JointMetric::wrapped(const Eigen::VectorXd& q) const {
  Eigen::VectorXd result = q;
  wrap(result.data());
  return result;
}

double JointMetric::squared_distance_around(const double* a, const double* b, int dimension) const {
  double sum = 0;
  for (int i = 0; i < dimension; ++i) {
    const double apart = weight(i) * (wraps(i) ? nearest_angle(b[i], a[i]) - b[i] : a[i] - b[i]);
    sum += apart * apart;
  }
  return sum;
}

void JointMetric::unroll(std::vector<Eigen::VectorXd>& waypoints) const {
  for (std::size_t w = 1; w < waypoints.size(); ++w)
    for (const int i : wrapping_) waypoints[w][i] = nearest_angle(waypoints[w - 1][i], waypoints[w][i]);
}

void JointMetric::split_long_edges(std::vector<Eigen::VectorXd>& waypoints) const {
  if (!any()) return;
  std::vector<Eigen::VectorXd> out(waypoints.begin(), waypoints.begin() + (waypoints.empty() ? 0 : 1));
  for (std::size_t w = 1; w < waypoints.size(); ++w) {
    const Eigen::VectorXd &from = waypoints[w - 1], &to = waypoints[w];
    double turn = 0;
    for (const int i : wrapping_) turn = std::max(turn, std::abs(to[i] - from[i]));
    const int pieces = std::max(1, static_cast<int>(std::ceil(turn / kPi)));
    for (int k = 1; k < pieces; ++k) out.push_back(from + (to - from) * (static_cast<double>(k) / pieces));
    out.push_back(to);
  }
  waypoints = std::move(out);
}

}  // namespace mmgrasp::detail
