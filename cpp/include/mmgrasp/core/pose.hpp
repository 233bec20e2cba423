#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"

namespace mmgrasp {

/// A rigid transform: rotation and translation [m]. T_a_b is the pose of frame b in frame a: p_a = T_a_b * p_b.
using Pose = Eigen::Isometry3d;
/// One pose after another, e.g. a Cartesian path.
using Poses = std::vector<Pose>;
/// A twist or a pose's error: three linear entries [m], then three angular ones [rad].
using Vector6d = Eigen::Matrix<double, 6, 1>;
/// A Jacobian: rows as in Vector6d, one column a joint.
using Matrix6Xd = Eigen::Matrix<double, 6, Eigen::Dynamic>;

/// URDF's convention: R = Rz(yaw) * Ry(pitch) * Rx(roll) [m, rad].
MMGRASP_EXPORT Pose pose_from_xyz_rpy(const Eigen::Vector3d& xyz, const Eigen::Vector3d& rpy);
/// Quaternion as (x, y, z, w); normalised here. Throws InvalidInput when its norm is off 1 by more than 1e-3.
MMGRASP_EXPORT Pose pose_from_xyz_quat(const Eigen::Vector3d& xyz, const Eigen::Vector4d& quat_xyzw);
/// The planar pose (x, y, theta) as a 3-D pose on the floor.
MMGRASP_EXPORT Pose pose_from_planar(const Eigen::Vector3d& x_y_theta);
/// Inverse of pose_from_xyz_rpy; at pitch = +-90 degrees roll is set to 0.
MMGRASP_EXPORT Eigen::Vector3d rpy_from_rotation(const Eigen::Matrix3d& R);
MMGRASP_EXPORT Eigen::Vector4d quat_xyzw_from_rotation(const Eigen::Matrix3d& R);

/// Rotation vector of R (angle times axis), angle in [0, pi]; exact near 0 and near pi.
MMGRASP_EXPORT Eigen::Vector3d rotation_vector(const Eigen::Matrix3d& R);
/// Twist-like difference, world-aligned: (p_to - p_from; rotation vector of R_to * R_from^T).
MMGRASP_EXPORT Vector6d pose_difference(const Pose& from, const Pose& to);
/// Angle between two rotations [rad], in [0, pi].
MMGRASP_EXPORT double rotation_distance(const Pose& a, const Pose& b);

/// Throws InvalidInput naming `field` unless finite, a rotation within 1e-6, last row 0 0 0 1, position within 1e6 m.
MMGRASP_EXPORT Pose checked_pose(const Eigen::Matrix4d& T, const std::string& field);

/// Angle wrapped to (-pi, pi].
MMGRASP_EXPORT double wrap_angle(double angle);

}  // namespace mmgrasp
