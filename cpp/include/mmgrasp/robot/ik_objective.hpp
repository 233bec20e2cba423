#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/robot/ik.hpp"

namespace mmgrasp {

/// A cost of configurations that inverse kinematics lowers with the freedom that the pose leaves (P3 3.5: q_p = (I -
/// J^+ J) xi, xi the sum of the negative gradients).
///
///     IkOptions options;
///     options.objectives = {make_joint_limit_objective(arm)};
///     const IkResult found = solve_ik(arm, T_world_tip, seed, options);
///
/// Immutable and safe to share between threads.
class MMGRASP_EXPORT IkObjective {
 public:
  explicit IkObjective(int size) : size_(size) {}
  virtual ~IkObjective();
  virtual std::string name() const = 0;
  /// Cost at q (its unit times a weight); `gradient` is set to d cost / d q. q must have size() entries.
  virtual double evaluate(const Eigen::VectorXd& q, Eigen::VectorXd& gradient) const = 0;
  int size() const { return size_; }  ///< Size of the group it was made for.

 private:
  int size_;
};

/// The part of `xi` that moves the joints but not the tip: (I - J^+ J) xi (P3 3.5, 5.7), J^+ the pseudo-inverse
/// weighted with `weights` > 0 (empty: 1 each), so that the result is the steepest such direction in that metric. J: 6
/// x n. Throws InvalidInput on lengths that do not match.
MMGRASP_EXPORT Eigen::VectorXd project_onto_null_space(const Matrix6Xd& J, const Eigen::VectorXd& xi,
                                                       const std::vector<double>& weights = {});

/// Keeps joints away from their limits (P3 5.9, 5.10, with the mirror for the lower limit): weight x squared depth [rad
/// or m] inside the outer `soft_fraction` of the range at each end, in (0, 0.5].
MMGRASP_EXPORT std::shared_ptr<const IkObjective> make_joint_limit_objective(const JointGroup& group,
                                                                             double soft_fraction = 0.1,
                                                                             double weight = 1.0);

/// Keeps the arm away from singularities (P3 5.11): weight x max(0, 1 - M / threshold)^2 with M = sqrt(det(J J^T)) of
/// the arm's joints (base columns left out).
MMGRASP_EXPORT std::shared_ptr<const IkObjective> make_singularity_objective(const JointGroup& group, double threshold,
                                                                             double weight = 1.0);

/// Keeps a world point near the optical axis (+z) of a camera on `camera_link` (P3 3.1, 3.6): weight x squared distance
/// [m^2] of the point from the axis, plus the squared depth by which it lies behind the camera.
MMGRASP_EXPORT std::shared_ptr<const IkObjective> make_camera_view_objective(const JointGroup& group, int camera_link,
                                                                             const Pose& T_link_camera,
                                                                             const Eigen::Vector3d& p_world_point,
                                                                             double weight = 1.0);

}  // namespace mmgrasp
