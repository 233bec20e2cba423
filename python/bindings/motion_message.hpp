#pragma once

#include <optional>

#include "arrays.hpp"
#include "mmgrasp/robot/robot_motion.hpp"
#include "shown.hpp"

namespace mmgrasp::python {

namespace annotations {
inline constexpr char kMotionMessage[] = "mmgrasp.records.MotionMessage";
}
using MotionMessage = Shown<annotations::kMotionMessage>;

/// x, y, theta of a standing base, or None.
std::optional<Eigen::Vector3d> base_pose_argument(const OptionalArray& base_pose);

/// The fields of a ROS trajectory_msgs/JointTrajectory, base_pose and base_twist at every point, and what the gripper
/// does.
MotionMessage motion_message(const RobotMotion& motion);

}  // namespace mmgrasp::python
