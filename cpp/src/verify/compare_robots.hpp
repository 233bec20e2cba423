#pragma once

#include "mmgrasp/verify/plan_check.hpp"
#include "verify/robot/robot_model.hpp"

namespace mmgrasp::verify::detail {

/// "robot-differs" for every link and joint that the planners knew otherwise than the URDFs say: names, tree, origins,
/// axes, limits, mimic joints, collision shapes. A primitive that stands in for a mesh must contain its bounds.
void compare_robots(const RobotModel& read, const RobotModel& planned, std::vector<Fault>& faults);

}  // namespace mmgrasp::verify::detail
