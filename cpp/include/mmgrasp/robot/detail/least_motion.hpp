#pragma once

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/robot/detail/joint_metric.hpp"
#include "mmgrasp/robot/ik.hpp"
#include "mmgrasp/robot/joint_group.hpp"

namespace mmgrasp::detail {

/// A lower bound on the length in joint space of every path of the group that takes the tip from one pose to the other
/// (each within the tolerances of IK), whatever the configurations at its ends: the tip cannot move or turn faster than
/// with every joint at its longest lever. Lengths are the metric's. Weak, but it holds for arms of which not every
/// configuration can be listed.
MMGRASP_EXPORT double least_motion(const JointGroup& group, const Pose& T_world_from, const Pose& T_world_to,
                                   const IkOptions& ik = {}, const JointMetric& metric = {});

}  // namespace mmgrasp::detail
