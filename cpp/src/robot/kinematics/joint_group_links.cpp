// Poses of all links of a group: each as one step from its parent.
#include <algorithm>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/robot/detail/joint_group_data.hpp"
#include "robot/model/joint_motion.hpp"

namespace mmgrasp {
namespace detail {
namespace {

void copy_columns(const Eigen::Matrix3d& R, double* to) {
  for (int c = 0; c < 3; ++c) {
    for (int r = 0; r < 3; ++r) to[4 * c + r] = R(r, c);
    to[4 * c + 3] = 0;
  }
}

void copy_vector(const Eigen::Vector3d& v, double* to) {
  for (int r = 0; r < 3; ++r) to[r] = v[r];
  to[3] = 0;
}

LinkStep link_step(const GroupModel& model, int index, GroupKinematics& kinematics) {
  const Joint& joint = model.robot.joints()[index];
  const Drive drive = drive_of(model, index);
  LinkStep step{};
  step.link = joint.child_link;
  step.parent = joint.parent_link;
  const Pose T = drive.column < 0 ? standing_pose(model, joint) : joint.T_parent_joint;
  const Eigen::Matrix3d R = T.linear();
  copy_columns(R, step.A);
  copy_vector(T.translation(), step.p);
  if (drive.column < 0) return step;
  switch (joint.type) {
    case JointType::fixed:
      break;
    case JointType::revolute:
    case JointType::continuous: {
      // Rodrigues: a a^T + sin [a]x + cos (1 - a a^T), with the fixed rotation multiplied in.
      const Eigen::Matrix3d along = joint.axis * joint.axis.transpose();
      step.kind = LinkStep::Kind::revolute;
      step.index = kinematics.link_angle_storage.add(drive.column, drive.multiplier, drive.offset);
      copy_columns(R * along, step.A);
      copy_columns(R * cross_matrix(joint.axis), step.B);
      copy_columns(R * (Eigen::Matrix3d::Identity() - along), step.C);
      break;
    }
    case JointType::prismatic:
      step.kind = LinkStep::Kind::prismatic;
      step.column = drive.column;
      step.multiplier = drive.multiplier;
      step.offset = drive.offset;
      copy_vector(R * joint.axis, step.d);
      break;
    case JointType::planar:
    case JointType::floating:
      step.kind = LinkStep::Kind::given;
      step.index = static_cast<int>(kinematics.given.size());
      kinematics.given.push_back({index, drive.column});
      break;
  }
  return step;
}

}  // namespace

void flatten_links(const GroupModel& model, GroupKinematics& kinematics) {
  const std::vector<Joint>& joints = model.robot.joints();
  std::vector<bool> moves(model.robot.links().size(), model.has_base);
  kinematics.mover_of_link.assign(moves.size(), -1);
  if (model.has_base) kinematics.moving_links.push_back(0);
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const Joint& joint = joints[i];
    const std::size_t link = joint.child_link, parent = joint.parent_link;
    const Drive drive = drive_of(model, static_cast<int>(i));
    kinematics.mover_of_link[link] = kinematics.mover_of_link[parent];
    if (drive.column >= 0) {
      kinematics.movers.push_back({static_cast<int>(i), drive.column, drive.multiplier,
                                   joint.T_parent_joint.linear() * joint.axis, kinematics.mover_of_link[parent]});
      kinematics.mover_of_link[link] = static_cast<int>(kinematics.movers.size()) - 1;
    }
    kinematics.all_steps.push_back(static_cast<int>(i));
    if (moves[parent] || drive.column >= 0) {
      moves[link] = true;
      kinematics.moving_links.push_back(joint.child_link);
      kinematics.moving_steps.push_back(static_cast<int>(i));
    }
    kinematics.steps.push_back(link_step(model, static_cast<int>(i), kinematics));
  }
  kinematics.link_angles = kinematics.link_angle_storage.padded();
  require(kinematics.link_angles.count <= kMaxRevolute - kAngleBlock, "group \"" + model.name + "\" turning joints",
          kinematics.link_angles.count, "must be at most " + std::to_string(kMaxRevolute - kAngleBlock));
}

}  // namespace detail
}  // namespace mmgrasp
