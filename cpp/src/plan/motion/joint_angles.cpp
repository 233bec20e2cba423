#include "plan/motion/joint_angles.hpp"

#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {

Eigen::VectorXd nearest_turn(const std::vector<bool>& wraps, const Eigen::VectorXd& from,
                             const Eigen::VectorXd& target) {
  Eigen::VectorXd result = target;
  for (Eigen::Index i = 0; i < result.size(); ++i) {
    if (wraps[i]) result[i] = from[i] + shortest_turn(target[i] - from[i]);
  }
  return result;
}

Eigen::VectorXd wrapped(const std::vector<bool>& wraps, const Eigen::VectorXd& q) {
  Eigen::VectorXd result = q;
  for (Eigen::Index i = 0; i < result.size(); ++i) {
    if (wraps[i]) result[i] = shortest_turn(q[i]);
  }
  return result;
}

}  // namespace mmgrasp::detail
