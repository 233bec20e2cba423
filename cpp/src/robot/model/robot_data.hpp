#pragma once

#include <map>
#include <set>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "mmgrasp/robot/detail/robot_record.hpp"

namespace mmgrasp {

using NamedPairs = std::map<std::pair<std::string, std::string>, DisabledReason>;

struct Robot::Data : detail::RobotContent {
  std::vector<Link> links;  // breadth first; joint i carries link i + 1
  std::vector<Joint> joints;
  std::map<std::pair<int, int>, DisabledReason> disabled_pairs;

  // Derived from the above.
  std::unordered_map<std::string, int> link_by_name;
  std::unordered_map<std::string, int> joint_by_name;
  int value_count = 0;
  Eigen::VectorXd default_values;
};

namespace detail {

/// A joint with its neighbours by name: what files and compositions talk about before indices exist.
struct NamedJoint {
  Joint joint;
  std::string parent, child;
  std::string mimic;  // name of the joint it follows; empty for none
  std::string place;  // for messages, e.g. "robot.urdf:12: <joint name=...>"
};

/// A robot by names: the common form of a parsed file, a mounted pair and an added link. build_robot turns it into
/// indices, after checking that it is one tree.
struct RobotParts : RobotContent {
  std::string origin;       // file, for messages
  std::vector<Link> links;  // indices unset
  std::vector<NamedJoint> joints;
  NamedPairs disabled_pairs;
};

/// Orders links and joints breadth first, resolves mimic joints, numbers values, disables pairs that cannot collide in
/// a meaningful way (joined by a joint or rigidly). Throws InvalidInput when the parts are no tree.
std::shared_ptr<Robot::Data> build_robot(const RobotParts& parts);
/// Pairs that build_robot disables by itself: joined by a joint (also across links without shapes) or one rigid body.
std::set<std::pair<int, int>> adjacent_pairs(const Robot::Data& data);
/// Names of a joint's values: its own for one; name/x, name/y, name/theta for planar joints; name/x, name/y, name/z,
/// name/rx, name/ry, name/rz (rotation vector) for floating ones.
std::vector<std::string> value_names(const Joint& joint);
RobotParts to_parts(const Robot::Data& data);

}  // namespace detail
}  // namespace mmgrasp
