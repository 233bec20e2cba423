#pragma once

#include <optional>
#include <string>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/robot/ik.hpp"
#include "mmgrasp/robot/trajectory.hpp"

namespace mmgrasp {

/// Steps in which plan_straight_line() follows its line, and from where on a step is a jump of the joints.
struct MMGRASP_EXPORT StraightLineOptions {
  double position_step = 0.005;  ///< Largest tool translation between two waypoints [m]; > 0.
  double rotation_step = 0.02;   ///< Largest tool rotation between two waypoints [rad]; > 0.
  double jump_threshold = 0.2;   ///< A larger joint motion between two waypoints is a jump [rad or m]; > 0.
  double joint_step = 0.02;      ///< Largest joint motion between two checks of an edge [rad or m]; > 0.
  IkOptions ik;
  void check() const;
};

/// Joint path along a straight line of the tool, or how far the arm came and what ended it there.
struct MMGRASP_EXPORT StraightLineResult {
  Outcome outcome = Outcome::not_found;
  std::optional<JointPath> path;  ///< From q_start to T_world_to; set if and only if solved.
  double fraction = 0;            ///< How far along the line the last good waypoint lies, in [0, 1].
  /// Why the line ended there: unreachable (also when only a jump of the joints leads on), limits, self_collision or
  /// scene.
  Rejection cause = Rejection::none;
  std::optional<Contact> contact;  ///< What touches there, when something does.
  std::string beyond_limits;       ///< With invalid_start: as in MotionResult. Empty: none is.
};

/// The tool moves on a straight line (rotation by slerp) from the pose of q_start to T_world_to, by dense IK in small
/// steps. Between waypoints, too, it stays within 1e-4 m of the line (with the default IK tolerance), and edges are
/// free at an eighth of joint_step. The outcome is solved, not_found, invalid_start or stopped. Throws InvalidInput on
/// bad lengths, poses or options, and on a group with a diff-drive base, which cannot follow such a path.
MMGRASP_EXPORT StraightLineResult plan_straight_line(CollisionChecker& checker, const Eigen::VectorXd& q_start,
                                                     const Pose& T_world_to, const StraightLineOptions& options = {},
                                                     const Monitor& monitor = {});

}  // namespace mmgrasp
