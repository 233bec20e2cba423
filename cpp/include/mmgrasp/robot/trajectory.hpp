#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"

namespace mmgrasp {

/// Configurations joined by straight lines in joint space.
struct MMGRASP_EXPORT JointPath {
  std::vector<Eigen::VectorXd> waypoints;
  double length() const;  ///< Sum of Euclidean joint distances.
};

/// A path on a clock: configurations with their times, and velocities and accelerations where they are known.
///
///     const JointTrajectory motion = time_parameterize(path, velocity_limits, acceleration_limits);
///     for (double t = 0; t <= motion.duration(); t += 0.01) send(motion.at(t));
struct MMGRASP_EXPORT JointTrajectory {
  std::vector<std::string> names;  ///< One per column of the configurations.
  std::vector<double> times;       ///< [s], from 0, strictly increasing.
  std::vector<Eigen::VectorXd> positions;
  std::vector<Eigen::VectorXd> velocities;
  std::vector<Eigen::VectorXd> accelerations;

  double duration() const { return times.empty() ? 0.0 : times.back(); }
  Eigen::VectorXd at(double time) const;  ///< Cubic Hermite between samples; clamped at the ends.
  std::string to_csv() const;             ///< Header "time,<name>,...,<name>.velocity,..."; 17 digits.
};

}  // namespace mmgrasp
