#include "robot/model/joint_motion.hpp"

#include <cmath>

namespace mmgrasp::detail {
namespace {

Pose planar_motion(const Eigen::Vector3d& normal, const double* values) {
  Pose T = Pose::Identity();
  T.translation() = planar_frame(normal).leftCols<2>() * Eigen::Vector2d(values[0], values[1]);
  T.linear() = Eigen::AngleAxisd(values[2], normal).toRotationMatrix();
  return T;
}

Pose floating_motion(const double* values) {
  Pose T = Pose::Identity();
  T.translation() = Eigen::Vector3d(values[0], values[1], values[2]);
  T.linear() = rotation_of(Eigen::Vector3d(values[3], values[4], values[5]));
  return T;
}

}  // namespace

Eigen::Matrix3d planar_frame(const Eigen::Vector3d& normal) {
  return Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), normal).toRotationMatrix();
}

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& a) {
  Eigen::Matrix3d M;
  M << 0, -a[2], a[1], a[2], 0, -a[0], -a[1], a[0], 0;
  return M;
}

Eigen::Matrix3d rotation_of(const Eigen::Vector3d& rotation_vector) {
  const double angle = rotation_vector.norm();
  if (!(angle > 0)) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, rotation_vector / angle).toRotationMatrix();
}

Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& rotation_vector) {
  constexpr double kSmall = 1e-6;  // where the next terms of the series are below rounding
  const double angle = rotation_vector.norm(), half = std::sin(0.5 * angle);
  const bool small = angle < kSmall;
  const double first = small ? 0.5 : 2 * half * half / (angle * angle);  // (1 - cos) / angle^2 without cancellation
  const double second = small ? 1.0 / 6.0 : (angle - std::sin(angle)) / (angle * angle * angle);
  const Eigen::Matrix3d W = cross_matrix(rotation_vector);
  return Eigen::Matrix3d::Identity() + first * W + second * W * W;
}

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
