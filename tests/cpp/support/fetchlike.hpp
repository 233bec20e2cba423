#pragma once

#include <map>
#include <string>

#include "mmgrasp/robot/joint_group.hpp"
#include "mmgrasp/robot/robot.hpp"

namespace mmgrasp::test {

inline Robot fetchlike(BaseKind base = BaseKind::diff_drive, const BaseLimits& limits = {}) {
  RobotOptions options;
  options.base = base;
  options.base_limits = limits;
  const std::string folder = std::string(MMGRASP_ASSETS) + "/robots/fetchlike/fetchlike";
  return Robot::load(folder + ".urdf", folder + ".srdf", options);
}

/// Base and arm with the lift held at 0.2 m.
inline JointGroup fetchlike_whole_body(BaseKind base = BaseKind::diff_drive, const BaseLimits& limits = {}) {
  const Robot robot = fetchlike(base, limits);
  return robot.group("arm", "gripper_link", base != BaseKind::fixed)
      .with_reference(robot.values({{"torso_lift_joint", 0.2}}));
}

}  // namespace mmgrasp::test
