#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "mmgrasp/robot/detail/ik_candidates.hpp"
#include "mmgrasp/robot/detail/whole_turns.hpp"
#include "mmgrasp/structure/object_path.hpp"

namespace mmgrasp::detail {

/// The configurations of one group that reach poses: every branch of an arm of six joints; of seven joints those for
/// evenly spread values of the redundant one; of either on a moving base those for every place of a grid of base poses,
/// which are the same for all poses of a path. Where there is no closed form, what random descents find.
class PathConfigurations {
 public:
  PathConfigurations(const JointGroup& group, const ObjectPathOptions& options);

  /// Chooses the base poses for tool poses to come; nothing to do for a group without a base. Throws InvalidInput when
  /// the grid has too many.
  void place_bases(const Poses& T_world_hand);

  struct Layer {
    Eigen::MatrixXd q;               ///< A column each.
    Eigen::VectorXd manipulability;  ///< Along the motion (P2 3.2.3.3.3); 0 without one.
    Rejections rejections;           ///< Causes for which configurations do not reach the pose.
  };
  /// `motion`: of the tool, a twist; zero for none.
  Layer at(const Pose& T_world_hand, const Vector6d& motion);

  /// The nearest to `seed` where all are known, else what a descent from there finds, then one from random starts.
  Layer single(const Pose& T_world_hand, const Vector6d& motion, const Eigen::VectorXd& seed);

  /// Several hundred configurations a pose, of which neighbours differ by the grid.
  bool sampled() const { return group_.has_base() || arm_->redundant_joint() >= 0; }

 private:
  double force(const Matrix6Xd& J, const Vector6d& motion) const;
  void add(const Eigen::VectorXd& q, const Matrix6Xd& J);
  void add_arm(const Pose& T_root_hand);
  Layer take(Eigen::Index count);

  const JointGroup& group_;
  const ObjectPathOptions& options_;
  std::optional<JointGroup> arm_group_;  ///< The arm without the base, its root at the identity.
  std::optional<ClosedFormSolver> arm_;
  std::optional<WholeTurns> turns_;
  Eigen::VectorXd middle_;
  std::vector<Eigen::Vector3d> bases_;
  // These belong to the pose at hand.
  Vector6d motion_;
  Eigen::VectorXd q_;
  Matrix6Xd J_;
  std::vector<double> values_, forces_;
  Rejections rejections_;
  bool partial_ = false;  ///< Configurations may have been missed.
};

}  // namespace mmgrasp::detail
