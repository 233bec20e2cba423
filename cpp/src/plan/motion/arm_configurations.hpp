#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "mmgrasp/core/outcome.hpp"
#include "mmgrasp/robot/ik.hpp"
#include "mmgrasp/robot/joint_group.hpp"

namespace mmgrasp::detail {

/// What is said of a configuration that reaches a pose.
struct ReachVerdict {
  Rejection cause = Rejection::none;
  bool final = false;  ///< Every other configuration that reaches the pose is turned down likewise.
};
using ReachFilter = std::function<ReachVerdict(const Eigen::VectorXd& q)>;

/// Up to `count` configurations that put the tip at a pose, as different as can be; those turned down are counted by
/// cause, a pose that nothing reaches as one `reach`. Closed forms first: most poses of many are turned down, and
/// they say so quickly. A redundant joint is sampled coarsely, then finely, before a few descents have the last word.
std::vector<Eigen::VectorXd> arm_configurations(const JointGroup& group, const Pose& T_world_tip, int count,
                                                const IkOptions& options, const ReachFilter& valid,
                                                Rejections& rejections);

}  // namespace mmgrasp::detail
