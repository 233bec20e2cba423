#pragma once

#include <Eigen/Core>

#include "mmgrasp/robot/joint_group.hpp"

namespace mmgrasp::detail {

/// Shifts each turning joint of `q` by whole turns towards `reference`, as far as limits allow: the same tool pose,
/// reached without winding up. Arms whose joints turn by more than 360 degrees have many such twins, and most are far
/// from home.
void turn_towards(const JointGroup& group, const Eigen::VectorXd& reference, Eigen::VectorXd& q);

}  // namespace mmgrasp::detail
