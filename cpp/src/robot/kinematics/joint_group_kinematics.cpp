// JointGroup: forward kinematics and Jacobians.
#include <array>
#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/robot/detail/joint_group_data.hpp"
#include "robot/model/joint_motion.hpp"

namespace mmgrasp {
namespace {

using detail::GroupKinematics;
using detail::Mover;
using detail::SphericalFrame;
using detail::SphericalMotion;

/// Works out the spherical motions of a chain; most have none, and pay nothing.
class SphericalMotions {
 public:
  SphericalMotions(const GroupKinematics& kinematics, const double* q) {
    if (kinematics.spherical.empty()) return;
    for (std::size_t i = 0; i < kinematics.spherical.size(); ++i) {
      const SphericalFrame& frame = kinematics.spherical[i];
      const Eigen::Map<const Eigen::Vector3d> w(q + frame.column);
      Eigen::Map<Eigen::Matrix3d>(motions_[i].R, 3, 3) = frame.before * detail::rotation_of(w) * frame.after;
      Eigen::Map<Eigen::Matrix3d>(motions_[i].axes, 3, 3) = frame.before * detail::left_jacobian(w);
    }
  }
  const SphericalMotion* data() const { return motions_; }

 private:
  SphericalMotion motions_[detail::kMaxSpherical];  // not initialised on purpose
};

}  // namespace

Pose JointGroup::fk(const Eigen::Ref<const Eigen::VectorXd>& q) const {
  Pose T_world_tip;
  const SphericalMotions spherical(*data_->kinematics, q.data());
  detail::kinematics_kernels().single(data_->kinematics->chain, data_->root, q.data(), spherical.data(),
                                      T_world_tip.data(), nullptr, 0);
  return T_world_tip;
}

Matrix6Xd JointGroup::jacobian(const Eigen::Ref<const Eigen::VectorXd>& q) const {
  Matrix6Xd J(6, size());
  Pose T_world_tip;
  fk_jacobian(q, T_world_tip, J);
  return J;
}

void JointGroup::fk_jacobian(const Eigen::Ref<const Eigen::VectorXd>& q, Pose& T_world_tip,
                             Eigen::Ref<Matrix6Xd> J) const {
  const SphericalMotions spherical(*data_->kinematics, q.data());
  detail::kinematics_kernels().single(data_->kinematics->chain, data_->root, q.data(), spherical.data(),
                                      T_world_tip.data(), J.data(), J.outerStride());
}

void JointGroup::link_poses(const Eigen::Ref<const Eigen::VectorXd>& q, Poses& T_world_link, bool moved_only) const {
  const GroupKinematics& kinematics = *data_->kinematics;
  const std::size_t count = robot().links().size();
  const bool all = !moved_only || T_world_link.size() != count;
  if (T_world_link.size() != count) T_world_link.assign(count, Pose::Identity());
  if (all || has_base()) T_world_link[0] = has_base() ? pose_from_planar(q.head<3>()) : data_->T_world_root;
  // Planar and floating joints have frames that are no links.
  const std::size_t frames = kinematics.tree.frames;
  if (frames != count) T_world_link.resize(frames, Pose::Identity());
  double* numbers = T_world_link[0].data();
  kinematics.place_frames(q.data(), numbers);
  kinematics.place_other_links(!all, numbers);
  if (frames != count) T_world_link.resize(count);
}

Matrix6Xd JointGroup::jacobian(const Eigen::Ref<const Eigen::VectorXd>& q, int link,
                               const Eigen::Vector3d& p_link_point) const {
  const int count = static_cast<int>(robot().links().size());
  require(link >= 0 && link < count, "link", link, "must be in [0, " + std::to_string(count) + ")");
  Poses T_world_link;
  link_poses(q, T_world_link);
  Matrix6Xd J(6, size());
  point_jacobian(T_world_link, q, link, T_world_link[link] * p_link_point, J);
  return J;
}

void JointGroup::point_jacobian(const Poses& T_world_link, const Eigen::Ref<const Eigen::VectorXd>& q, int link,
                                const Eigen::Vector3d& p_world_point, Eigen::Ref<Matrix6Xd> J) const {
  const GroupKinematics& kinematics = *data_->kinematics;
  const std::vector<Joint>& joints = robot().joints();
  J.setZero();
  for (int i = kinematics.mover_of_link[link]; i >= 0;) {
    const Mover& mover = kinematics.movers[i];
    i = mover.next;
    const Joint& joint = joints[mover.joint];
    const auto R_parent = T_world_link[joint.parent_link].linear();
    // Whatever turns, turns about the child's origin.
    const Eigen::Vector3d lever = p_world_point - T_world_link[joint.child_link].translation();
    const auto turn = [&](int column, const Eigen::Vector3d& w) {
      J.col(column).head<3>() += w.cross(lever);
      J.col(column).tail<3>() += w;
    };
    switch (joint.type) {
      case JointType::fixed:
        break;
      case JointType::revolute:
      case JointType::continuous:
        turn(mover.column, mover.multiplier * (R_parent * mover.axis));
        break;
      case JointType::prismatic:
        J.col(mover.column).head<3>() += mover.multiplier * (R_parent * mover.axis);
        break;
      case JointType::planar: {
        const Eigen::Matrix3d R = R_parent * joint.T_parent_joint.linear() * detail::planar_frame(joint.axis);
        J.block<3, 2>(0, mover.column) = R.leftCols<2>();
        turn(mover.column + 2, R.col(2));
        break;
      }
      case JointType::floating: {
        const Eigen::Matrix3d R = R_parent * joint.T_parent_joint.linear();
        J.block<3, 3>(0, mover.column) = R;
        const Eigen::Matrix3d W = R * detail::left_jacobian(q.segment<3>(mover.column + 3));
        for (int k = 0; k < 3; ++k) turn(mover.column + 3 + k, W.col(k));
        break;
      }
    }
  }
  if (!has_base()) return;
  const Eigen::Vector3d lever = p_world_point - T_world_link[0].translation();
  J(0, 0) = 1;
  J(1, 1) = 1;
  J.col(2) << -lever[1], lever[0], 0, 0, 0, 1;
}

}  // namespace mmgrasp
