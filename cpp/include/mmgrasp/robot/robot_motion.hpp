#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/robot/trajectory.hpp"

namespace mmgrasp {

/// The gripper opens or closes; it takes `duration` from `time` on.
struct MMGRASP_EXPORT GripperEvent {
  double time = 0;                                            ///< [s]
  double duration = 0;                                        ///< [s], >= 0
  bool closes = true;                                         ///< Otherwise it opens.
  double opening = std::numeric_limits<double>::quiet_NaN();  ///< Opening afterwards [m]; NaN: not known.
  std::string object;                                         ///< What is held afterwards, or no longer; may be empty.
};

/// What a robot carries out: arm, base and gripper on one clock, from 0. Between points arm velocities are interpolated
/// as in JointTrajectory, the base's twist linearly.
///
///     RobotMotion motion = robot_motion(approach, base_pose);
///     motion.wait(0.5);                            // the fingers close
///     motion.append(robot_motion(lift, base_pose));  // must begin where the motion stands
///     write(motion.to_csv());
struct MMGRASP_EXPORT RobotMotion {
  std::vector<std::string> joints;  ///< Names of the arm's joints; one per column.
  std::vector<double> times;        ///< [s], from 0, strictly increasing.
  std::vector<Eigen::VectorXd> positions, velocities, accelerations;
  std::vector<Eigen::Vector3d> base_poses;   ///< x, y, theta in the world; theta is not wrapped.
  std::vector<Eigen::Vector3d> base_twists;  ///< v_x, v_y, omega in the platform's frame, as in ROS.
  std::vector<GripperEvent> gripper;         ///< What the gripper does, ordered by time.

  double duration() const { return times.empty() ? 0.0 : times.back(); }
  /// Base and arm stand still at the end for so long [s], e.g. while the gripper closes.
  void wait(double duration);
  /// `next` begins where this ends: base (headings up to whole turns) and joints to 1e-6, velocities too. Throws
  /// InvalidInput where they differ.
  void append(const RobotMotion& next);
  /// Header "time,base.x,base.y,base.theta,base.v,base.vy,base.omega,<joint>,...,<joint>.velocity,...,
  /// <joint>.acceleration,...", and where it does anything ",gripper": what it begins to do up to the row's time, once.
  /// 17 digits.
  std::string to_csv() const;
};

/// Makes the motion of a trajectory: columns x, y, theta, where it begins with them, are the base's; otherwise the base
/// stands at `base_pose` (the origin when not given). Throws InvalidInput for a trajectory without velocities or
/// accelerations, and for a `base_pose` beside a base that moves.
MMGRASP_EXPORT RobotMotion robot_motion(const JointTrajectory& trajectory,
                                        const std::optional<Eigen::Vector3d>& base_pose = {});

}  // namespace mmgrasp
