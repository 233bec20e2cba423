#pragma once

#include <Eigen/Core>

#include "mmgrasp/robot/trajectory.hpp"
#include "plan/timing/path_timing.hpp"

namespace mmgrasp::detail {

constexpr double kMaxSamples = 1e7;  // With seven joints these take 2 GB.

/// Largest speed of the cubic with end speeds v0 and v1 and mean speed `mean` over a time h.
double cubic_peak_speed(double mean, double v0, double v1, double h);

/// Samples at most `period` apart whose cubic Hermite interpolation, which is what gets executed, keeps both limits.
/// Samples stand where accelerations jump, and closer together where a cubic would overshoot; what is left
/// over the limits is removed by slowing the whole motion down. Throws TimingStopped, and InvalidInput on a `period`
/// that would give more samples than memory holds.
JointTrajectory sample_trajectory(const PathTiming& timing, const Eigen::VectorXd& velocity_limits,
                                  const Eigen::VectorXd& acceleration_limits, double period);

}  // namespace mmgrasp::detail
