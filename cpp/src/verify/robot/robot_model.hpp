#pragma once

#include <kdl/tree.hpp>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "mmgrasp/robot/robot_source.hpp"

namespace mmgrasp::verify::detail {

enum class JointKind { fixed, revolute, continuous, prismatic, planar, floating };
const char* to_string(JointKind kind);

struct ModelJoint {
  std::string name;
  JointKind kind = JointKind::fixed;
  int parent = -1, child = -1;        ///< Link indices.
  KDL::Frame T_parent_child;          ///< Pose of the child while the joint is at zero.
  KDL::Vector axis = {1, 0, 0};       ///< Unit, in the child's frame.
  double lower = 0, upper = 0;        ///< [rad] or [m]; infinite where there is no limit.
  double velocity = 0;                ///< [rad/s] or [m/s]
  int source = -1;                    ///< Joint whose value it follows: itself, or what it mimics in the end:
  double multiplier = 1, offset = 0;  ///< value = multiplier * value of `source` + offset.

  bool turns() const { return kind == JointKind::revolute || kind == JointKind::continuous; }
  bool moves() const { return turns() || kind == JointKind::prismatic; }
};

struct ModelLink {
  std::string name;
  int joint = -1;  ///< The joint that carries it; -1: the root.
  std::vector<int> child_joints;
  std::vector<LinkShape> shapes;
  bool shapes_left_out = false;  ///< Some of its meshes were not loaded by those who planned.
};

/// The robot as the check knows it: its URDFs read again by urdfdom, its meshes by assimp, joined into one KDL tree.
/// Nothing of what Robot understood is used.
struct RobotModel {
  BaseKind base = BaseKind::fixed;
  BaseLimits base_limits;
  std::vector<ModelLink> links;      ///< Breadth first, the root first.
  std::vector<ModelJoint> joints;    ///< Joint i carries link i + 1.
  KDL::Tree tree;                    ///< One segment a link, called like it.
  using Pair = std::pair<int, int>;  ///< Link indices, the smaller one first.
  std::map<Pair, bool> disabled;     ///< Pairs that the SRDF disables; true: because the links can never touch.
  std::set<Pair> enabled;            ///< Pairs that the SRDF enables, against the rule for neighbours.

  int link_index(const std::string& name) const;   ///< -1: none.
  int joint_index(const std::string& name) const;  ///< -1: none.
};

/// Throws InvalidInput naming file, element and reason for what cannot be read. Without `load_meshes` the meshes have
/// paths and scales only.
RobotModel read_robot(const RobotSource& source, bool load_meshes = true);

}  // namespace mmgrasp::verify::detail
