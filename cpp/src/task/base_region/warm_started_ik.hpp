#pragma once

#include <Eigen/Core>

#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/robot/joint_group.hpp"

namespace mmgrasp::detail {

/// Newton's method from a configuration whose tool is near by (a few centimetres, a tenth of a radian): gives up where
/// refine_ik() would search on. The hot loop of base regions. Keeps limits. One per thread.
class WarmStartedIk {
 public:
  explicit WarmStartedIk(const JointGroup& arm);
  /// Solves from q, in place. True when the tool is at the pose within the tolerances of IkOptions' defaults.
  bool solve(const Pose& T_base_tip, Eigen::VectorXd& q);

 private:
  bool step(Eigen::VectorXd& q, const Vector6d& error, double damping);

  JointGroup arm_;
  Matrix6Xd J_;
  Eigen::VectorXd dq_;
  double position_tolerance_, rotation_tolerance_;
};

}  // namespace mmgrasp::detail
