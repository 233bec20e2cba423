#pragma once

#include <Eigen/Core>
#include <vector>

#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/robot/trajectory.hpp"

namespace mmgrasp::detail {

/// Reduces the deviation of corners where `motion`, as it is executed, is farther from the polyline `waypoints` than
/// `allowed` at the corner says [rad or m]: halves it, down to a stop (0). Both have one entry per inner waypoint.
/// Returns whether nothing had to change: then the motion keeps what is allowed, or stops at every corner. Throws
/// TimingStopped.
bool keeps_deviation(const JointTrajectory& motion, const std::vector<Eigen::VectorXd>& waypoints,
                     const std::vector<double>& allowed, std::vector<double>& deviations, const CancelToken& stop);

}  // namespace mmgrasp::detail
