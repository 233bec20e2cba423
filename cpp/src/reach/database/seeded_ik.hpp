#pragma once

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/reach/reach_database.hpp"
#include "mmgrasp/robot/ik.hpp"

namespace mmgrasp::detail {

/// Descents that start from a database's configurations; scratch of one thread.
class SeededIk {
 public:
  /// Throws InvalidInput.
  SeededIk(const ReachDatabase& database, const JointGroup& arm, const IkOptions& options);

  const JointGroup& arm() const { return arm_; }  ///< The arm, its root at the origin.
  /// Looks up to `count` starts up, nearest first; returns how many there are.
  int seed(const Pose& T_base_tip, int count);
  /// Descends from a start; true when q() is exact and within limits, confirmed by forward kinematics.
  bool refine(const Pose& T_base_tip, int seed);
  const Eigen::VectorXd& q() const { return q_; }

 private:
  ReachDatabase database_;
  JointGroup arm_;
  IkOptions options_;
  IkWorkspace workspace_;
  Eigen::MatrixXd seeds_;
  Eigen::VectorXd q_;
};

/// Throws InvalidInput unless the checker (may be null) is of a group like the arm.
void check_checker(const CollisionChecker* checker, const JointGroup& arm);

}  // namespace mmgrasp::detail
