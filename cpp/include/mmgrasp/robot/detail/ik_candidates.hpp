#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/robot/detail/ik_closed_form.hpp"
#include "mmgrasp/robot/ik.hpp"

namespace mmgrasp::detail {

/// What the closed form of a group says about a pose, polished but not yet held against limits.
struct Candidates {
  bool known_form = false;   ///< The group has a closed form.
  int redundant_joint = -1;  ///< Column that was sampled.
  int without = 0;           ///< Sampled values (or the one search) without any branch.
  bool free = false;         ///< Singular: a joint could take any value, of which one was kept.
  std::vector<Eigen::VectorXd> q;
};

/// The closed form of one group, prepared for many poses.
class MMGRASP_EXPORT ClosedFormSolver {
 public:
  /// `values`: of the redundant joint, where there is one.
  ClosedFormSolver(const JointGroup& group, int values);

  bool known_form() const { return known_form_; }
  int redundant_joint() const { return locked_; }

  /// A branch, polished, each angle in the turn nearest to the middle of its limits, and the Jacobian there.
  using Use = std::function<void(const Eigen::VectorXd& q, const Matrix6Xd& J)>;
  struct Counts {
    int without = 0;    ///< Sampled values (or the one search) without any branch.
    int far = 0;        ///< Branches farther outside the limits than asked for, which were not polished.
    bool free = false;  ///< Singular: a joint could take any value, of which one was kept.
  };
  /// Every branch that is not outside its limits by more than `outside` [rad] before it is polished. Not thread-safe.
  Counts solve(const Pose& T_world_tip, double outside, const Use& use);

 private:
  void turn_inside(Eigen::VectorXd& q) const;
  bool known(std::size_t count) const;

  JointGroup group_;
  Screws screws_;
  ClosedForm form_;
  bool known_form_ = false;
  int locked_ = -1, values_ = 1;
  double lower_ = 0, cell_ = 0;  ///< Least of the locked joint's values and the distance between two of them.
  Eigen::VectorXd middle_, q_;
  std::vector<Eigen::VectorXd> kept_;  ///< Solutions at one locked value; grows and is used again.
  IkWorkspace workspace_;
};

/// Whole turns are chosen so that each value is nearest to the middle of its limits. `values`: of the redundant joint.
Candidates closed_form_candidates(const JointGroup& group, const Pose& T_world_tip, int values);

/// Euclidean, angles without limits the short way.
double joint_distance(const JointGroup& group, const Eigen::VectorXd& a, const Eigen::VectorXd& b);

/// The same arm posture with whole turns taken so that each angle is nearest to `reference`, as far as limits allow.
Eigen::VectorXd turned_towards(const JointGroup& group, const Eigen::VectorXd& q, const Eigen::VectorXd& reference);

/// How far q lies outside its limits: the sum over the joints [rad or m].
double limit_violation(const JointGroup& group, const Eigen::VectorXd& q);

/// True when forward kinematics and the limits confirm q; fills the errors.
bool confirm(const JointGroup& group, const Pose& T_world_tip, const Eigen::VectorXd& q, const IkOptions& options,
             double& position_error, double& rotation_error);

void check_target(const JointGroup& group, const Pose& T_world_tip, const IkOptions& options);

}  // namespace mmgrasp::detail
