#include "mmgrasp/robot/detail/frame_tree.hpp"

#include "mmgrasp/robot/detail/joint_group_data.hpp"
#include "robot/model/joint_motion.hpp"

namespace mmgrasp::detail {
namespace {

struct AxisMotion {
  Motion motion;
  Eigen::Vector3d axis;
};

/// A column of the configuration each, but for the spherical one, which takes three.
std::vector<AxisMotion> motions_of(const Joint& joint) {
  const auto along = [](const Eigen::Matrix3d& frame, int axis) -> AxisMotion {
    return {Motion::prismatic, frame.col(axis)};
  };
  switch (joint.type) {
    case JointType::fixed:
      break;
    case JointType::revolute:
    case JointType::continuous:
      return {{Motion::revolute, joint.axis}};
    case JointType::prismatic:
      return {{Motion::prismatic, joint.axis}};
    case JointType::planar: {
      const Eigen::Matrix3d plane = planar_frame(joint.axis);
      return {along(plane, 0), along(plane, 1), {Motion::revolute, plane.col(2)}};
    }
    case JointType::floating: {
      const Eigen::Matrix3d own = Eigen::Matrix3d::Identity();
      return {along(own, 0), along(own, 1), along(own, 2), {Motion::spherical, own.col(2)}};
    }
  }
  return {};
}

}  // namespace

Eigen::Matrix3d rotation_from_z(const Eigen::Vector3d& axis) {
  // Exact, where the general formula has to choose an axis by its rounding.
  if (axis == -Eigen::Vector3d::UnitZ()) return Eigen::Vector3d(1, -1, -1).asDiagonal();
  return Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), axis).toRotationMatrix();
}

FrameTree::FrameTree(const GroupModel& model)
    : frames(static_cast<int>(model.robot.links().size())),
      motion_of_frame(model.robot.links().size(), -1),
      frame_of_link(model.robot.links().size(), 0),
      link_in_frame(model.robot.links().size()) {
  const std::vector<Joint>& joints = model.robot.joints();
  for (std::size_t index = 0; index < joints.size(); ++index) {
    const Joint& joint = joints[index];
    const Drive drive = drive_of(model, static_cast<int>(index));
    int frame = frame_of_link[joint.parent_link];
    const Rigid& parent = link_in_frame[joint.parent_link];
    if (drive.column < 0) {
      frame_of_link[joint.child_link] = frame;
      link_in_frame[joint.child_link] = parent * Rigid(standing_pose(model, joint));
      continue;
    }
    Rigid rest = parent * Rigid(joint.T_parent_joint);
    const std::vector<AxisMotion> parts = motions_of(joint);
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const bool last = i + 1 == parts.size();
      const int own = last ? joint.child_link : frames++;
      // Only joints of one value mimic, so that the columns of others follow each other plainly.
      const Drive of_part{drive.column + static_cast<int>(i), drive.multiplier, drive.offset};
      motion_of_frame.resize(frames, -1);
      motion_of_frame[own] = static_cast<int>(motions.size());
      motions.push_back({own, frame, rest, parts[i].axis, parts[i].motion, of_part});
      frame = own;
      rest = Rigid();
    }
    frame_of_link[joint.child_link] = frame;
  }
}

std::vector<const ElementaryMotion*> FrameTree::motions_above(int frame) const {
  std::vector<const ElementaryMotion*> out;
  for (int at = motion_of_frame[frame]; at >= 0; at = motion_of_frame[motions[at].parent]) out.push_back(&motions[at]);
  return out;
}

}  // namespace mmgrasp::detail
