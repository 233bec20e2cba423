#pragma once

#include <array>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/robot/joint_group.hpp"
#include "structure/bound/linear_form.hpp"

namespace mmgrasp::detail {

/// A pose of the tip that depends on two variables.
struct FormPose {
  std::array<FormVector, 3> axes;  ///< Columns of the rotation.
  FormVector origin;
  FormVector turned(const Eigen::Vector3d& v) const {
    return {axes[0][0] * LinearForm(v.x()) + axes[1][0] * LinearForm(v.y()) + axes[2][0] * LinearForm(v.z()),
            axes[0][1] * LinearForm(v.x()) + axes[1][1] * LinearForm(v.y()) + axes[2][1] * LinearForm(v.z()),
            axes[0][2] * LinearForm(v.x()) + axes[1][2] * LinearForm(v.y()) + axes[2][2] * LinearForm(v.z())};
  }
};

/// Six joint values; then, of an arm whose wrist axes 4 and 6 are parallel at zero, value 4 + wrist_sign() * value 6,
/// up to whole turns: known well where the wrist is stretched and the two are not.
using FormConfiguration = std::array<LinearForm, 7>;

/// Encloses every configuration of a six-joint arm over a box of poses: the closed forms of inverse kinematics, each
/// step carried out on linear forms, so none is missed. Arms whose axes 4, 5 and 6 meet and 2 and 3 are parallel, or
/// whose axes 2, 3 and 4 are parallel and 5 and 6 meet.
class MMGRASP_EXPORT IkEnclosure {
 public:
  /// Whether a group has such a geometry.
  static bool takes(const JointGroup& group);
  /// Throws InvalidInput for other groups; what an arm is off its special geometry (at most 1e-6) widens all answers.
  explicit IkEnclosure(const JointGroup& group);

  /// Joint values up to whole turns; limits are not checked.
  std::vector<FormConfiguration> branches(const FormPose& T_world_tip) const;
  /// Each in every whole turn that may lie within limits.
  std::vector<FormConfiguration> within_limits(const FormPose& T_world_tip) const;
  /// J^T (v, w) at a configuration that puts the tip there.
  std::array<LinearForm, 6> joint_effects(const FormConfiguration& q, const FormPose& T_world_tip, const FormVector& v,
                                          const Eigen::Vector3d& w) const;
  /// 1 or -1; 0: there is no sum.
  int wrist_sign() const { return wrist_sign_; }

 private:
  struct Turn {
    LinearForm c, s;
    explicit Turn(const LinearForm& angle) : c(cosine(angle)), s(sine(angle)) {}
  };
  FormVector turned(int joint, const Turn& turn, bool back, const FormVector& v) const;
  FormVector turned_point(int joint, const Turn& turn, bool back, const FormVector& x) const;
  std::vector<LinearForm> to_plane(const Eigen::Vector3d& axis, const Eigen::Vector3d& k, const FormVector& u,
                                   const LinearForm& d) const;
  LinearForm onto(const Eigen::Vector3d& axis, const FormVector& u, const FormVector& v) const;
  void spherical(const FormPose& T_world_tip, std::vector<FormConfiguration>& out) const;
  void euler_wrist(const FormVector& Rx, const FormVector& Ry, const FormVector& Rz, const FormConfiguration& arm,
                   std::vector<FormConfiguration>& out) const;
  void parallel(const FormPose& T_world_tip, std::vector<FormConfiguration>& out) const;
  /// Where a direction, a point of the tip goes that is given where the tip stands at zero.
  FormVector carried_direction(const FormPose& T, const Eigen::Vector3d& v) const;
  FormVector carried_point(const FormPose& T, const Eigen::Vector3d& x) const;

  JointGroup group_;
  std::array<Eigen::Vector3d, 6> h_, p_;  ///< Axes at zero, snapped to the special geometry.
  Eigen::Matrix3d R_tip_;
  Eigen::Vector3d t_tip_;
  Eigen::Vector3d meeting_;  ///< Where the wrist's axes meet (4, 5, 6; or 5, 6).
  bool spherical_ = false;
  int wrist_sign_ = 0;
  double off_rotation_ = 0, off_position_ = 0;  ///< What snapping and polishing leave.
};

}  // namespace mmgrasp::detail
