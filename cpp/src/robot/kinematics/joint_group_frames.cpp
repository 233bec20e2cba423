// Poses of a group's frames and links: each one step from the frame that carries it.
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

FrameStep resting_step(int frame, int parent, const Rigid& T) {
  FrameStep step{};
  step.frame = frame;
  step.parent = parent;
  copy_columns(T.R, step.A);
  copy_vector(T.t, step.p);
  return step;
}

FrameStep step_of(const ElementaryMotion& motion, Angles& angles) {
  FrameStep step = resting_step(motion.frame, motion.parent, motion.rest);
  const Eigen::Matrix3d& R = motion.rest.R;
  step.column = motion.drive.column;
  switch (motion.motion) {
    case Motion::revolute: {
      // Rodrigues: a a^T + sin [a]x + cos (1 - a a^T), with the fixed rotation multiplied in.
      const Eigen::Matrix3d along = motion.axis * motion.axis.transpose();
      step.kind = FrameStep::Kind::revolute;
      step.angle = angles.add(motion.drive.column, motion.drive.multiplier, motion.drive.offset);
      copy_columns(R * along, step.A);
      copy_columns(R * cross_matrix(motion.axis), step.B);
      copy_columns(R * (Eigen::Matrix3d::Identity() - along), step.C);
      break;
    }
    case Motion::prismatic:
      step.kind = FrameStep::Kind::prismatic;
      step.multiplier = motion.drive.multiplier;
      step.offset = motion.drive.offset;
      copy_vector(R * motion.axis, step.d);
      break;
    case Motion::spherical:
      step.kind = FrameStep::Kind::spherical;
      break;
  }
  return step;
}

/// The motions that make the Jacobian of a point, by link.
void find_movers(const GroupModel& model, GroupKinematics& kinematics) {
  const std::vector<Joint>& joints = model.robot.joints();
  kinematics.mover_of_link.assign(model.robot.links().size(), -1);
  for (std::size_t i = 0; i < joints.size(); ++i) {
    const Joint& joint = joints[i];
    const Drive drive = drive_of(model, static_cast<int>(i));
    int& mover = kinematics.mover_of_link[joint.child_link];
    mover = kinematics.mover_of_link[joint.parent_link];
    if (drive.column < 0) continue;
    kinematics.movers.push_back(
        {static_cast<int>(i), drive.column, drive.multiplier, joint.T_parent_joint.linear() * joint.axis, mover});
    mover = static_cast<int>(kinematics.movers.size()) - 1;
  }
}

}  // namespace

void flatten_frames(const GroupModel& model, GroupKinematics& kinematics) {
  const FrameTree& tree = kinematics.tree;
  find_movers(model, kinematics);
  for (const ElementaryMotion& motion : tree.motions)
    kinematics.steps.push_back(step_of(motion, kinematics.frame_angle_storage));
  std::vector<FrameStep> standing;
  if (model.has_base) kinematics.moving_links.push_back(0);
  for (int link = 1; link < static_cast<int>(model.robot.links().size()); ++link) {
    const bool moves = model.has_base || tree.frame_of_link[link] != 0;
    if (moves) kinematics.moving_links.push_back(link);
    if (tree.motion_of_frame[link] >= 0) continue;
    (moves ? kinematics.steps : standing)
        .push_back(resting_step(link, tree.frame_of_link[link], tree.link_in_frame[link]));
  }
  kinematics.moving_steps = static_cast<int>(kinematics.steps.size());
  kinematics.steps.insert(kinematics.steps.end(), standing.begin(), standing.end());
  kinematics.frame_angles = kinematics.frame_angle_storage.padded();
  require(kinematics.frame_angles.count <= kMaxRevolute - kAngleBlock, "group \"" + model.name + "\" revolute joints",
          kinematics.frame_angles.count, "must be at most " + std::to_string(kMaxRevolute - kAngleBlock));
}

}  // namespace detail
}  // namespace mmgrasp
