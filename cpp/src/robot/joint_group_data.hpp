#pragma once

#include <memory>
#include <string>
#include <vector>

#include "mmgrasp/robot/joint_group.hpp"

namespace mmgrasp {
namespace detail {

constexpr int kMaxGroupSize = 64;  ///< Lets Jacobians live on the stack.

/// One moving joint on the way from the root to the tip. Its frame is turned so that it moves about or along its own z;
/// everything fixed since the joint before is folded into (R, p).
struct ChainSegment {
  Eigen::Matrix3d R;
  Eigen::Vector3d p;
  bool prismatic = false;
  int column = 0;  ///< Configuration entry that moves it: joint value = multiplier * q[column] + offset.
  double multiplier = 1;
  double offset = 0;
};

/// Pose of a link in its parent link. For a moving joint R = A + sin(v) B + cos(v) C, p = p0 + v d.
struct LinkStep {
  int link = 0, parent = 0;
  int column = -1;  ///< -1: constant, R = A and p = p0.
  bool prismatic = false;
  double multiplier = 1, offset = 0;
  Eigen::Matrix3d A, B, C;
  Eigen::Vector3d p0, d;
};

/// Everything of a group but where its root stands; shared by all its copies.
struct GroupModel {
  Robot robot;
  std::string name;
  std::vector<std::string> names;
  std::vector<int> joints;  ///< Robot joint indices, in column order after the base.
  bool has_base = false;
  int tip_link = 0;
  Eigen::VectorXd lower, upper, velocity, acceleration, reference;
  std::vector<bool> wraps;
  std::vector<ChainSegment> chain;  ///< Base joints are not in it: they are the root's pose.
  Eigen::Matrix3d R_tip;            ///< Last segment (or the root) to the tip.
  Eigen::Vector3d p_tip;
  std::vector<LinkStep> steps;  ///< Every link but the root, breadth first.
  std::vector<int> moving_links;
  std::vector<int> moving_steps;  ///< Indices into steps.
  double reach = 0;               ///< Bound on the distance from first_joint (or the root) to the tip [m].
  Eigen::Vector3d first_joint = Eigen::Vector3d::Zero();  ///< Where it starts, in the root.

  explicit GroupModel(Robot r) : robot(std::move(r)) {}
  int base_columns() const { return has_base ? 3 : 0; }
};

/// Fills chain, tip, steps and moving links from robot, joints, tip and reference.
void flatten(GroupModel& model);

/// Joint indices must be movable with one value and not mimic; `tip_link` any link.
JointGroup make_group(const Robot& robot, const std::string& name, const std::vector<int>& joints, int tip_link,
                      bool with_base);

}  // namespace detail

struct JointGroup::Data {
  std::shared_ptr<const detail::GroupModel> model;
  Pose T_world_root = Pose::Identity();
};

}  // namespace mmgrasp
