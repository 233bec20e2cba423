#pragma once

#include "mmgrasp/grasp/hand.hpp"
#include "mmgrasp/robot/joint_group.hpp"

namespace mmgrasp::detail {

/// The same group with its fingers as the grasp holds.
inline JointGroup with_fingers(const JointGroup& group, const Hand& hand, const Grasp& grasp) {
  Eigen::VectorXd values = group.reference();
  const Robot& robot = group.robot();
  for (const auto& [name, value] : hand.joint_values(grasp))
    values[robot.joints()[robot.joint_index(name)].value_index] = value;
  return group.with_reference(values);
}

}  // namespace mmgrasp::detail
