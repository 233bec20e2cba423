#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/core/export.hpp"
#include "mmgrasp/robot/trajectory.hpp"

namespace mmgrasp {

struct MMGRASP_EXPORT TimingOptions {
  double max_deviation = 0.01;   ///< Corners are blended within this joint distance [rad]; >= 0; 0 stops at every corner.
  double sample_period = 0.02;   ///< Spacing of the samples returned [s]; > 0.
  void check() const;
};

/// Near time-optimal timing of a path under velocity and acceleration limits, at rest at both ends: corners are blended by
/// circular arcs, then path velocity is maximised by forward and backward integration on a fine grid. Every sample keeps
/// both limits (checked before return, slack 1e-6 relative). Throws InvalidInput on wrong lengths or limits <= 0.
MMGRASP_EXPORT JointTrajectory time_parameterize(const JointPath& path, const Eigen::VectorXd& velocity_limits,
                                                 const Eigen::VectorXd& acceleration_limits,
                                                 const TimingOptions& options = {},
                                                 const std::vector<std::string>& names = {});

/// time_parameterize whose blended corners are checked for collisions: the deviation is halved (down to 0, stopping at the
/// corners) until the whole trajectory is free at `edge_step`.
MMGRASP_EXPORT JointTrajectory time_parameterize_free(CollisionChecker& checker, const JointPath& path,
                                                      const TimingOptions& options = {}, double edge_step = 0.01);

}  // namespace mmgrasp
