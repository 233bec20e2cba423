#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/robot/robot.hpp"

namespace mmgrasp {

/// Some joints of a robot that are planned together, and a tip: where its configurations, limits and kinematics are.
///
///     const JointGroup arm = robot.group("arm", "tool");
///     const Pose T_world_tool = arm.fk(q);
///     const IkResult found = solve_ik(arm, T_world_tool, seed);
///
/// - Configuration: base joints x, y, theta first when the group has them, then the chain in order.
/// - A planar joint has three columns, "<joint>/x", "<joint>/y" and "<joint>/theta"; a floating one six, "<joint>/x",
///   "/y", "/z" and its rotation vector "/rx", "/ry", "/rz". Their translations lie in the base's workspace bound, the
///   entries of a rotation vector in [-pi, pi]; theta wraps.
/// - All other joints stay at the group's reference values; without base joints the root stands at `T_world_root`.
/// - Immutable, cheap to copy, safe to share between threads.
class MMGRASP_EXPORT JointGroup {
 public:
  const Robot& robot() const;
  const std::string& name() const;
  const std::vector<std::string>& names() const;  ///< "x", "y", "theta" first when the group has the base.
  const std::vector<int>& joints() const;         ///< Robot joint of each column; -1 for the base's.
  int size() const;
  bool has_base() const;
  int tip_link() const;
  const Eigen::VectorXd& lower() const;  ///< +-infinite for continuous joints.
  const Eigen::VectorXd& upper() const;
  const Eigen::VectorXd& velocity_limits() const;
  const Eigen::VectorXd& acceleration_limits() const;  ///< URDF has none: 4 x velocity limit unless set.
  const std::vector<bool>& wraps() const;              ///< True for values that are angles without limits.

  /// The same group with other joints held elsewhere, e.g. fingers opened (full value vector, Robot::values()).
  JointGroup with_reference(const Eigen::VectorXd& full_values) const;
  /// The same group with the robot's root standing elsewhere. Throws InvalidInput when the group has base joints.
  JointGroup at(const Pose& T_world_root) const;
  JointGroup with_acceleration_limits(const Eigen::VectorXd& limits) const;
  const Eigen::VectorXd& reference() const;
  const Pose& T_world_root() const;

  bool within_limits(const Eigen::VectorXd& q, double slack = 0) const;
  /// Finite bounds for sampling: limits, with continuous joints in [-pi, pi].
  Eigen::VectorXd sample_lower() const;
  Eigen::VectorXd sample_upper() const;
  /// Reference values with this configuration put in (without base joints).
  Eigen::VectorXd full_values(const Eigen::VectorXd& q) const;
  Pose root_pose(const Eigen::VectorXd& q) const;
  /// Throws InvalidInput naming `field`, the length expected and the index of a non-finite entry.
  void check_configuration(const Eigen::VectorXd& q, const std::string& field) const;

  /// T_world_tip. No allocation.
  Pose fk(const Eigen::Ref<const Eigen::VectorXd>& q) const;
  /// World-aligned Jacobian at the tip's origin: rows v then w, columns as names().
  Matrix6Xd jacobian(const Eigen::Ref<const Eigen::VectorXd>& q) const;
  /// Both at once into caller's storage: the hot path of IK. J must be 6 x size(). No allocation.
  void fk_jacobian(const Eigen::Ref<const Eigen::VectorXd>& q, Pose& T_world_tip, Eigen::Ref<Matrix6Xd> J) const;
  /// Pose of every link of the robot into caller's storage (resized once). Only links the group moves are recomputed
  /// when `T_world_link` was filled by this same group before and `moved_only` is set.
  void link_poses(const Eigen::Ref<const Eigen::VectorXd>& q, Poses& T_world_link, bool moved_only = false) const;
  /// Links whose pose depends on q, ascending.
  const std::vector<int>& moving_links() const;

  /// World-aligned Jacobian at a point that moves with `link`, given in that link's frame; 6 x size(). Zero columns for
  /// joints that do not move it.
  Matrix6Xd jacobian(const Eigen::Ref<const Eigen::VectorXd>& q, int link, const Eigen::Vector3d& p_link_point) const;
  /// The same for a point in the world and links that link_poses(q) has placed. J must be 6 x size(). No allocation.
  void point_jacobian(const Poses& T_world_link, const Eigen::Ref<const Eigen::VectorXd>& q, int link,
                      const Eigen::Vector3d& p_world_point, Eigen::Ref<Matrix6Xd> J) const;

  /// sqrt(det(J J^T)) (Yoshikawa; P1 3.2.1).
  double manipulability(const Eigen::Ref<const Eigen::VectorXd>& q) const;

  struct Data;
  explicit JointGroup(std::shared_ptr<const Data> data);
  const Data& data() const { return *data_; }

 private:
  std::shared_ptr<const Data> data_;
};

}  // namespace mmgrasp
