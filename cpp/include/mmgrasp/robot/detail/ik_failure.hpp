#pragma once

#include "mmgrasp/robot/detail/ik_descent.hpp"

namespace mmgrasp::detail {

/// Tells "out of reach" from "reached only outside joint limits" by going on without limits from where a descent
/// failed. One per pose.
class FailureCause {
 public:
  Rejection of(const JointGroup& group, const Pose& T_world_tip, Eigen::VectorXd q, const IkOptions& options,
               IkWorkspace& workspace) {
    if (!reached_ && tries_ < kTries) {
      ++tries_;
      reached_ = descend(group, T_world_tip, q, options, workspace, false).converged;
    }
    return reached_ ? Rejection::limits : Rejection::unreachable;
  }

 private:
  static constexpr int kTries = 3;  // the answer belongs to the pose: no need to ask again for each of 30 descents
  int tries_ = 0;
  bool reached_ = false;
};

}  // namespace mmgrasp::detail
