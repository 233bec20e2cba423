#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/robot/trajectory.hpp"

namespace mmgrasp {

/// How far a timed motion may cut the corners of its path, its jerk, and how densely it is sampled.
struct MMGRASP_EXPORT TimingOptions {
  /// Corners are blended within this joint distance [rad]; >= 0; 0 stops at every corner.
  double max_deviation = 0.01;
  double sample_period = 0.02;  ///< Largest time between samples [s]; > 0. They are denser where accelerations jump.
  /// Jerk limit of each joint [rad/s^3]; > 0; empty: none. The motion is then the moving average of a faster one: it
  /// stays on straight edges and takes the window's time longer. Corners that averaging would round by more than
  /// `max_deviation` are passed on tighter arcs, or stopped at.
  Eigen::VectorXd jerk_limits;
  void check() const;
};

/// Near time-optimal timing of a path under velocity and acceleration limits, at rest at both ends:
///
///     const JointTrajectory motion = time_parameterize(*result.path, velocity_limits, acceleration_limits);
///     // motion.times[i] [s], motion.positions[i], motion.velocities[i], motion.accelerations[i]
///
/// Corners are blended by circular arcs, then path velocity is maximised by forward and backward integration on a fine
/// grid. Every sample keeps both limits (checked before return, slack 1e-6 relative), and so does the cubic Hermite
/// interpolation between them. A path that goes nowhere gives one sample at time 0. Names default to joint_1, joint_2,
/// ... Returns an empty trajectory (no times) when stopped. Throws InvalidInput on wrong lengths or limits that are not
/// finite and > 0.
MMGRASP_EXPORT JointTrajectory time_parameterize(const JointPath& path, const Eigen::VectorXd& velocity_limits,
                                                 const Eigen::VectorXd& acceleration_limits,
                                                 const TimingOptions& options = {},
                                                 const std::vector<std::string>& names = {},
                                                 const Monitor& monitor = {});

/// time_parameterize whose interpolated trajectory is checked for collisions at `joint_step` [rad or m]: the deviation
/// of a corner next to one is halved (down to 0, stopping there) until the whole trajectory is free. Returns an empty
/// trajectory (no times) when the straight edges of the path themselves are not free, and when stopped. Limits and
/// names are those of the checker's group.
MMGRASP_EXPORT JointTrajectory time_parameterize_free(CollisionChecker& checker, const JointPath& path,
                                                      const TimingOptions& options = {}, double joint_step = 0.01,
                                                      const Monitor& monitor = {});

}  // namespace mmgrasp
