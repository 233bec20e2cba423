#pragma once

#include "mmgrasp/robot/joint_group.hpp"
#include "mmgrasp/robot/robot.hpp"

namespace mmgrasp::python {

/// Throws InvalidInput that says what differs unless the group is of this robot.
void check_same_robot(const Robot& robot, const JointGroup& group);

}  // namespace mmgrasp::python
