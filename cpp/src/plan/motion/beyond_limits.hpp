#pragma once

#include <Eigen/Core>
#include <string>

#include "mmgrasp/robot/joint_group.hpp"

namespace mmgrasp::detail {

/// The joint value farthest outside of its limits, in words; empty when all are within.
std::string beyond_limits(const JointGroup& group, const Eigen::VectorXd& q);

}  // namespace mmgrasp::detail
