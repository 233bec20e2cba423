#include "plan/motion/joint_angles.hpp"

#include <cmath>

namespace mmgrasp::detail {

Eigen::VectorXd nearest_turn(const std::vector<bool>& wraps, const Eigen::VectorXd& from,
                             const Eigen::VectorXd& target) {
  Eigen::VectorXd result = target;
  for (Eigen::Index i = 0; i < result.size(); ++i) {
    if (wraps[i]) result[i] = from[i] + std::remainder(target[i] - from[i], 2 * M_PI);
  }
  return result;
}

Eigen::VectorXd wrapped(const std::vector<bool>& wraps, const Eigen::VectorXd& q) {
  Eigen::VectorXd result = q;
  for (Eigen::Index i = 0; i < result.size(); ++i) {
    if (wraps[i]) result[i] = std::remainder(q[i], 2 * M_PI);
  }
  return result;
}

}  // namespace mmgrasp::detail
