#pragma once

#include <Eigen/Core>

#include "mmgrasp/task/drive_by.hpp"
#include "support/vec.hpp"

namespace mmgrasp::test {

/// The drive of the Fetch-like robot on which parts are taken in passing: whole-body configurations (x, y, theta, arm).
inline const Eigen::VectorXd kDriveStart = Eigen::VectorXd::Zero(10);
inline const Eigen::VectorXd kDriveGoal = vec({10, 0, -1, 1.13, 0.3, 1.9, 1.1, 2.1, 0.5, 2.5});

inline DriveByTask grasp_at(const Pose& T) {
  DriveByTask task;
  task.candidates = {T};
  return task;
}

}  // namespace mmgrasp::test
