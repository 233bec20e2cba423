#pragma once

#include <string>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/grasp/finger_length_range.hpp"
#include "mmgrasp/gripper_design/gripper.hpp"
#include "mmgrasp/robot/joint_group.hpp"

namespace mmgrasp {

/// A gripper on six joints that carry its base anywhere: x, y, z [m], then yaw, pitch, roll [rad]. Its robot is read
/// from the gripper's own files; the fingers' joint is "finger_1_joint". Throws InvalidInput for a wrong gripper,
/// IoError where no file can be written for the while.
MMGRASP_EXPORT JointGroup free_gripper(const Gripper& gripper);

/// What a gripper meets first when it goes through an operation, told by the collision checker: while it approaches the
/// active parts from 0.1 m away, grasps them, moves them, and lets go and moves back as far. Looked at every 0.5 mm and
/// 0.01 rad. "<link> meets <part> during <stage>", or empty: nothing. Throws as free_gripper() does, and InvalidInput
/// for a wrong grasp or operation.
MMGRASP_EXPORT std::string rehearse_operation(const Gripper& gripper, const AssemblyGrasp& grasp,
                                              const AssemblyOperation& operation);

}  // namespace mmgrasp
