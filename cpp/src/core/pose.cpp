#include "mmgrasp/core/pose.hpp"

#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"

namespace mmgrasp {

Pose pose_from_xyz_rpy(const Eigen::Vector3d& xyz, const Eigen::Vector3d& rpy) {
  const double cr = std::cos(rpy[0]), sr = std::sin(rpy[0]);
  const double cp = std::cos(rpy[1]), sp = std::sin(rpy[1]);
  const double cy = std::cos(rpy[2]), sy = std::sin(rpy[2]);
  Pose T = Pose::Identity();
  T.linear() << cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr,  //
      sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr,            //
      -sp, cp * sr, cp * cr;
  T.translation() = xyz;
  return T;
}

Pose pose_from_xyz_quat(const Eigen::Vector3d& xyz, const Eigen::Vector4d& quat_xyzw) {
  const double norm = quat_xyzw.norm();
  require(std::abs(norm - 1.0) <= 1e-3, "quat_xyzw norm", norm, "must be 1 within 1e-3");
  const Eigen::Vector4d q = quat_xyzw / norm;
  Pose T = Pose::Identity();
  T.linear() = Eigen::Quaterniond(q[3], q[0], q[1], q[2]).toRotationMatrix();
  T.translation() = xyz;
  return T;
}

Pose pose_from_planar(const Eigen::Vector3d& x_y_theta) {
  const double c = std::cos(x_y_theta[2]), s = std::sin(x_y_theta[2]);
  Pose T = Pose::Identity();
  T.linear() << c, -s, 0, s, c, 0, 0, 0, 1;
  T.translation() << x_y_theta[0], x_y_theta[1], 0;
  return T;
}

Eigen::Vector3d rpy_from_rotation(const Eigen::Matrix3d& R) {
  const double cos_pitch = std::hypot(R(0, 0), R(1, 0));
  const double pitch = std::atan2(-R(2, 0), cos_pitch);
  if (cos_pitch < 1e-12) return {0.0, pitch, std::atan2(-R(0, 1), R(1, 1))};
  const double yaw = std::atan2(R(1, 0), R(0, 0));
  // Roll from the yaw just found: near the singularity both are noisy, but they stay consistent with each other.
  const double c = std::cos(yaw), s = std::sin(yaw);
  const double roll = std::atan2(R(0, 2) * s - R(1, 2) * c, R(1, 1) * c - R(0, 1) * s);
  return {roll, pitch, yaw};
}

Eigen::Vector4d quat_xyzw_from_rotation(const Eigen::Matrix3d& R) {
  Eigen::Quaterniond q(R);
  q.normalize();
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  return q.coeffs();
}

Eigen::Vector3d rotation_vector(const Eigen::Matrix3d& R) {
  const Eigen::Quaterniond q(R);
  const double sin_half = q.vec().norm();
  const double cos_half = std::abs(q.w());
  const double sign = q.w() < 0 ? -1.0 : 1.0;
  // atan2 keeps full precision at both ends, where acos of a trace loses half of the digits.
  const double factor = sin_half > 1e-12 ? 2.0 * std::atan2(sin_half, cos_half) / sin_half : 2.0 / cos_half;
  return sign * factor * q.vec();
}

Vector6d pose_difference(const Pose& from, const Pose& to) {
  Vector6d difference;
  difference.head<3>() = to.translation() - from.translation();
  difference.tail<3>() = rotation_vector(to.linear() * from.linear().transpose());
  return difference;
}

double rotation_distance(const Pose& a, const Pose& b) {
  return rotation_vector(b.linear() * a.linear().transpose()).norm();
}

Pose checked_pose(const Eigen::Matrix4d& T, const std::string& field) {
  // Messages are put together for what is refused only: lists of grasps hold thousands of poses.
  const auto want = [&](bool ok, const char* what, double value, const char* rule) {
    if (!ok) require(false, field + what, value, rule);
  };
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      if (!std::isfinite(T(row, column)))
        want(false, ("(" + std::to_string(row) + ", " + std::to_string(column) + ")").c_str(), T(row, column),
             "must be finite");
  const Eigen::Matrix3d R = T.topLeftCorner<3, 3>();
  const double skew = (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  want(skew <= 1e-6, " rotation, largest entry of R^T R - I", skew, "must be at most 1e-6");
  const double determinant = R.determinant();
  want(determinant > 0, " rotation determinant", determinant, "must be +1 (a mirror is no rotation)");
  const double last_row = (T.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).cwiseAbs().maxCoeff();
  want(last_row <= 1e-9, " last row, distance from 0 0 0 1", last_row, "must be 0");
  require_position(T.topRightCorner<3, 1>(), field);
  Pose pose = Pose::Identity();
  pose.linear() = R;
  pose.translation() = T.topRightCorner<3, 1>();
  return pose;
}

double wrap_angle(double angle) {
  if (angle > -detail::kPi && angle <= detail::kPi) return angle;
  const double wrapped = detail::shortest_turn(angle);
  return wrapped <= -detail::kPi ? detail::kPi : wrapped;
}

}  // namespace mmgrasp
