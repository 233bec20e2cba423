#pragma once

#include <Eigen/Core>
#include <map>
#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/robot/robot_source.hpp"
#include "mmgrasp/verify/plan_to_check.hpp"

namespace mmgrasp::verify {

/// An arm's joint path among bodies that stand still.
struct MMGRASP_EXPORT PathToCheck {
  explicit PathToCheck(RobotSource checked_robot) : robot(std::move(checked_robot)) {}

  RobotSource robot;                           ///< E.g. source_of(robot).
  std::vector<std::string> joints;             ///< One a value of a waypoint.
  std::map<std::string, double> other_joints;  ///< Where the others stand; those not named at zero.
  std::vector<CheckedBody> bodies;
  std::vector<CheckedPair> allowed_collisions;  ///< Links or bodies that may touch.
  std::vector<Eigen::VectorXd> waypoints;       ///< Joined by straight lines in joint space.
};

/// Whether a path is free, and if not, where it first touches or leaves its limits.
struct MMGRASP_EXPORT PathCheckResult {
  bool free = false;
  std::string where;  ///< E.g. "edge 3 at 0.42: 'hand' touches 'can'"; empty when free.
  std::size_t configurations_checked = 0;
};

/// Looks at a path in steps of at most `joint_step` [rad or m] in any joint, ends included: joint limits (slack 1e-6),
/// links against each other and against the bodies. The robot read by urdfdom, kinematics by KDL and collisions by FCL,
/// as check_plan does; the robot's root stands at the origin. Throws InvalidInput on robots it cannot read, names it
/// does not know, wrong lengths and a step that is not > 0. Stopped by the monitor, a path is not free: `where` says
/// so.
MMGRASP_EXPORT PathCheckResult check_path(const PathToCheck& path, double joint_step = 0.005,
                                          const Monitor& monitor = {});

}  // namespace mmgrasp::verify
