#include "task/problem/full_turns.hpp"

#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {

void turn_towards(const JointGroup& group, const Eigen::VectorXd& reference, Eigen::VectorXd& q) {
  constexpr double kTurn = kTwoPi;
  const Robot& robot = group.robot();
  for (int j = 0; j < group.size(); ++j) {
    const int joint = group.joints()[j];
    if (joint < 0) continue;
    const JointType type = robot.joints()[joint].type;
    if (type != JointType::revolute && type != JointType::continuous) continue;
    const double step = reference[j] > q[j] ? kTurn : -kTurn;
    while (std::abs(q[j] + step - reference[j]) < std::abs(q[j] - reference[j]) && q[j] + step >= group.lower()[j] &&
           q[j] + step <= group.upper()[j]) {
      q[j] += step;
    }
  }
}

}  // namespace mmgrasp::detail
