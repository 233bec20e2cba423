#pragma once

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/robot/robot.hpp"
#include "mmgrasp/robot/robot_source.hpp"

namespace mmgrasp {

using GroupStates = std::map<std::string, std::map<std::string, std::map<std::string, double>>>;

namespace detail {

/// How an SRDF ties the robot to the world. Kept to be written out again: here the base kind says how the root moves.
struct VirtualJoint {
  std::string name, type, parent_frame, child_link;
};

/// What is known of a robot and does not depend on how its links and joints are found: by index or by name.
struct RobotContent {
  std::string name;
  BaseKind base = BaseKind::fixed;
  BaseLimits base_limits;
  RobotReport report;
  std::vector<GroupDescription> groups;
  std::vector<EndEffectorDescription> end_effectors;
  GroupStates group_states;
  std::vector<std::string> passive_joints;
  std::vector<VirtualJoint> virtual_joints;
  bool has_srdf = false;
  std::map<std::string, std::string> inertials;  // link -> its <inertial> as XML: nothing here computes with it
  std::set<std::string> shapes_left_out;  // links whose meshes were not loaded: without shapes here, but not in truth
  std::vector<UrdfSource> urdfs;          // what it was read from
  std::vector<AddedLink> added_links;     // and what came from no URDF
};

/// A whole robot as plain data: what of it goes to another process.
struct RobotRecord {
  RobotContent content;
  std::vector<Link> links;
  std::vector<Joint> joints;
  std::map<std::pair<int, int>, DisabledReason> disabled_pairs;
  Eigen::VectorXd default_values;
};

MMGRASP_EXPORT RobotRecord record_of(const Robot& robot);
MMGRASP_EXPORT Robot robot_of(RobotRecord record);

}  // namespace detail
}  // namespace mmgrasp
