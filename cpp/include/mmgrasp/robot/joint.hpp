#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/geometry/shape.hpp"

namespace mmgrasp {

/// How a link moves against its parent, by URDF's names; `continuous` is a revolute joint without limits.
enum class JointType { fixed, revolute, continuous, prismatic, planar, floating };
MMGRASP_EXPORT const char* to_string(JointType type);

/// One URDF joint: where a child link sits on its parent, and how it may move against it. Planar joints have 3 values
/// (x, y, theta), floating ones 6 (x, y, z, rotation vector), fixed 0, others 1.
struct MMGRASP_EXPORT Joint {
  std::string name;
  JointType type = JointType::fixed;
  int parent_link = -1;
  int child_link = -1;
  Pose T_parent_joint = Pose::Identity();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();          ///< Unit, in the joint frame.
  double lower = -std::numeric_limits<double>::infinity();  ///< [rad] or [m]; infinite for continuous.
  double upper = std::numeric_limits<double>::infinity();
  double velocity = std::numeric_limits<double>::infinity();  ///< [rad/s] or [m/s]
  double effort = std::numeric_limits<double>::infinity();
  int mimic_joint = -1;  ///< Index of the joint it follows: q = multiplier * q_followed + offset.
  double mimic_multiplier = 1;
  double mimic_offset = 0;
  int value_index = -1;  ///< First index in a full value vector; -1 for fixed and mimic joints.

  int value_count() const;
};

/// A collision or visual shape fixed to a link.
struct MMGRASP_EXPORT LinkShape {
  Shape shape;
  Pose T_link_shape = Pose::Identity();
  std::string mesh_uri;   ///< As written in the URDF; empty for primitives.
  std::string mesh_path;  ///< Resolved file; empty for primitives.
  Eigen::Vector3d mesh_scale = Eigen::Vector3d::Ones();
};

/// One URDF link: a rigid body with its collision shapes, and its joints as indices into Robot::joints().
struct MMGRASP_EXPORT Link {
  std::string name;
  int parent_joint = -1;  ///< -1 for the root.
  std::vector<int> child_joints;
  std::vector<LinkShape> collisions;
};

}  // namespace mmgrasp
