#pragma once

#include <Eigen/Core>
#include <vector>

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
