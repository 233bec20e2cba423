#pragma once

#include <Eigen/Core>

#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/robot/trajectory.hpp"

namespace mmgrasp::detail {

/// The moving average over a window of T seconds of a motion that starts and ends at rest: it takes T longer, stays
/// within the window's convex hull (so on every straight edge), keeps all limits that are the same everywhere, and its
/// jerk is the difference of two accelerations T apart, over T. T is the least that bisection finds to keep
/// `jerk_limits` [rad/s^3]. At inner stops the motion waits for T, so that no corner is cut. Where a T of 0.1 ms keeps
/// them, the limits do not bind and the motion comes back as it is. Names are passed on. Throws TimingStopped, and
/// InvalidInput on limits so low that the motion would take more samples than memory holds.
JointTrajectory limit_jerk(const JointTrajectory& motion, const Eigen::VectorXd& velocity_limits,
                           const Eigen::VectorXd& acceleration_limits, const Eigen::VectorXd& jerk_limits,
                           double period, const CancelToken& stop);

}  // namespace mmgrasp::detail
