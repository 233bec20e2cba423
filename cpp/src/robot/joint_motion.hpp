#pragma once

#include "mmgrasp/robot/joint.hpp"

namespace mmgrasp::detail {

/// Pose of a joint's child link in the joint's frame for its values (value_count() of them).
Pose joint_motion(const Joint& joint, const double* values);

}  // namespace mmgrasp::detail
