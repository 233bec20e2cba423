#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

namespace mmgrasp::test {

/// The image of `to` nearest to `from`, by trying whole turns of each value that wraps.
inline Eigen::VectorXd nearest_image(const std::vector<bool>& wraps, const Eigen::VectorXd& from,
                                     const Eigen::VectorXd& to) {
  Eigen::VectorXd best = to;
  for (Eigen::Index i = 0; i < to.size(); ++i)
    for (int k = -6; k <= 6 && wraps[i]; ++k)
      if (std::abs(to[i] + 2 * M_PI * k - from[i]) < std::abs(best[i] - from[i])) best[i] = to[i] + 2 * M_PI * k;
  return best;
}

/// Distance the short way round in the values that wrap; `weights`, unless empty, scale the values.
inline double distance_around(const std::vector<bool>& wraps, const Eigen::VectorXd& a, const Eigen::VectorXd& b,
                              const Eigen::VectorXd& weights = {}) {
  double sum = 0;
  const Eigen::VectorXd off = nearest_image(wraps, a, b) - a;
  for (Eigen::Index i = 0; i < off.size(); ++i) sum += std::pow((weights.size() > 0 ? weights[i] : 1) * off[i], 2);
  return std::sqrt(sum);
}

}  // namespace mmgrasp::test
