#include "robot/joint_motion.hpp"

namespace mmgrasp::detail {
namespace {

Pose planar_motion(const Eigen::Vector3d& normal, const double* values) {
  // x and y lie in the plane whose normal is the axis; for the usual axis z they are the joint frame's own.
  const Eigen::Quaterniond tilt = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), normal);
  Pose T = Pose::Identity();
  T.translation() = tilt * Eigen::Vector3d(values[0], values[1], 0);
  T.linear() = Eigen::AngleAxisd(values[2], normal).toRotationMatrix();
  return T;
}

Pose floating_motion(const double* values) {
  Pose T = Pose::Identity();
  T.translation() = Eigen::Vector3d(values[0], values[1], values[2]);
  const Eigen::Vector3d turn(values[3], values[4], values[5]);
  const double angle = turn.norm();
  if (angle > 0) T.linear() = Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
  return T;
}

}  // namespace

Pose joint_motion(const Joint& joint, const double* values) {
  Pose T = Pose::Identity();
  switch (joint.type) {
    case JointType::fixed:
      break;
    case JointType::revolute:
    case JointType::continuous:
      T.linear() = Eigen::AngleAxisd(values[0], joint.axis).toRotationMatrix();
      break;
    case JointType::prismatic:
      T.translation() = values[0] * joint.axis;
      break;
    case JointType::planar:
      return planar_motion(joint.axis, values);
    case JointType::floating:
      return floating_motion(values);
  }
  return T;
}

}  // namespace mmgrasp::detail
