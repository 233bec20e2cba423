#pragma once

#include <Eigen/Core>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/robot/joint_group.hpp"

namespace mmgrasp {

/// Length of the velocity ellipsoid along a direction of tool motion: (z^T (J J^T)^-1 z)^(-1/2) (P2 3.2). `direction`
/// has 3 entries (translation: J's upper rows) or 6 (twist, world-aligned); it is normalised. 0 where the tool cannot
/// move along it. Throws InvalidInput on a zero or non-finite direction (P2's z is undefined when the tool stands
/// still).
MMGRASP_EXPORT double velocity_manipulability(const JointGroup& group, const Eigen::VectorXd& q,
                                              const Eigen::VectorXd& direction);

/// Length of the force ellipsoid along it: (z^T J J^T z)^(-1/2) (P2 3.3). Infinite where no joint works against such a
/// force. alpha beta <= 1, with equality along the ellipsoids' axes only.
MMGRASP_EXPORT double force_manipulability(const JointGroup& group, const Eigen::VectorXd& q,
                                           const Eigen::VectorXd& direction);

}  // namespace mmgrasp
