#pragma once

#include "mmgrasp/robot/ik.hpp"

namespace mmgrasp::detail {

/// Where one descent ended.
struct DescentEnd {
  bool converged = false;
  double position_error = 0;  ///< [m]
  double rotation_error = 0;  ///< [rad]
  int iterations = 0;
};

/// Damped least squares from q (in place). With `keep_limits`, q is clamped first and never leaves its limits.
DescentEnd descend(const JointGroup& group, const Pose& T_world_tip, Eigen::VectorXd& q, const IkOptions& options,
                   IkWorkspace& workspace, bool keep_limits);

/// False when the tip surely cannot get within `tolerance` [m] of the position: that is farther from the first joint
/// than all links stretched.
bool maybe_in_reach(const JointGroup& group, const Eigen::Vector3d& position, double tolerance = 0);

}  // namespace mmgrasp::detail
