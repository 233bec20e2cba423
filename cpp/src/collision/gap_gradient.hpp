#pragma once

#include "mmgrasp/robot/joint_group.hpp"

namespace mmgrasp::detail {

/// Adds sign * n^T J to `row`, J being the positional Jacobian of a point that moves with `link`: how fast it moves
/// along n for each joint. `links` as link_poses(q) placed them; `p` and `n` in the world.
void add_point_speed(const JointGroup& group, const Poses& links, int link, const Eigen::Vector3d& p,
                     const Eigen::Vector3d& n, double sign, Eigen::VectorXd& row);

}  // namespace mmgrasp::detail
