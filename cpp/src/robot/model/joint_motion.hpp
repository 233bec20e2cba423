#pragma once

#include "mmgrasp/robot/joint.hpp"

namespace mmgrasp::detail {

/// Pose of a joint's child link in the joint's frame for its values (value_count() of them).
Pose joint_motion(const Joint& joint, const double* values);

/// x and y of a planar joint lie along the first two columns, its normal along the third: for the usual axis z they are
/// the joint frame's own.
Eigen::Matrix3d planar_frame(const Eigen::Vector3d& normal);
Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& a);
Eigen::Matrix3d rotation_of(const Eigen::Vector3d& rotation_vector);
/// Maps the rate of a rotation vector to the angular velocity, seen from the frame it starts in.
Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& rotation_vector);

}  // namespace mmgrasp::detail
