#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "mmgrasp/core/outcome.hpp"
#include "mmgrasp/robot/ik.hpp"
#include "mmgrasp/robot/joint_group.hpp"

namespace mmgrasp::detail {

/// Answer of a filter about a configuration that reaches a pose.
struct ReachVerdict {
  Rejection cause = Rejection::none;
  bool final = false;  ///< Every other configuration that reaches the pose would be rejected, too.
};
using ReachFilter = std::function<ReachVerdict(const Eigen::VectorXd& q)>;

struct ArmConfigurations {
  std::vector<Eigen::VectorXd> q;
  bool all = false;  ///< Proven: no other arm posture that reaches the pose passes the filter.
};

/// Up to `count` configurations that put the tip at a pose, as different as can be; rejected ones are counted by cause,
/// a pose without any as one `unreachable`. Closed forms come first: most poses of many are rejected, which they find
/// out fast. A redundant joint is sampled at few values, then at many, before a few numerical solutions are tried.
ArmConfigurations arm_configurations(const JointGroup& group, const Pose& T_world_tip, int count,
                                     const IkOptions& options, const ReachFilter& valid, Rejections& rejections);

}  // namespace mmgrasp::detail
