#pragma once

#include <string>

#include "mmgrasp/robot/joint_group.hpp"

/// A robot that is one body flying freely: q = (x, y, z, yaw, pitch, roll), so that T_world_body is known in closed
/// form.
namespace free_body {

inline std::string joint(const std::string& name, const std::string& type, const std::string& axis,
                         const std::string& parent, const std::string& child) {
  return "<link name='" + child + "'/><joint name='" + name + "' type='" + type + "'><parent link='" + parent +
         "'/><child link='" + child + "'/><axis xyz='" + axis +
         "'/><limit lower='-10' upper='10' velocity='1' effort='1'/></joint>";
}

inline mmgrasp::Robot robot(const std::vector<mmgrasp::LinkShape>& shapes) {
  const std::string urdf = "<robot name='free'><link name='root'/>" + joint("x", "prismatic", "1 0 0", "root", "a") +
                           joint("y", "prismatic", "0 1 0", "a", "b") + joint("z", "prismatic", "0 0 1", "b", "c") +
                           joint("yaw", "revolute", "0 0 1", "c", "d") + joint("pitch", "revolute", "0 1 0", "d", "e") +
                           joint("roll", "revolute", "1 0 0", "e", "carrier") + "</robot>";
  const mmgrasp::Robot bare = mmgrasp::Robot::from_strings(urdf);
  return shapes.empty() ? bare : bare.with_link("body", "carrier", mmgrasp::Pose::Identity(), shapes);
}

inline mmgrasp::JointGroup group(const std::vector<mmgrasp::LinkShape>& shapes) {
  return robot(shapes).chain("root", "carrier");
}

inline mmgrasp::LinkShape link_shape(const mmgrasp::Shape& shape) {
  mmgrasp::LinkShape out;
  out.shape = shape;
  return out;
}

inline mmgrasp::Pose pose(const Eigen::VectorXd& q) {
  mmgrasp::Pose T = mmgrasp::Pose::Identity();
  T.translation() = q.head<3>();
  T.linear() = (Eigen::AngleAxisd(q[3], Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(q[4], Eigen::Vector3d::UnitY()) *
                Eigen::AngleAxisd(q[5], Eigen::Vector3d::UnitX()))
                   .toRotationMatrix();
  return T;
}

}  // namespace free_body
