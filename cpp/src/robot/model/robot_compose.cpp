// Robots mounted on robots, added links, and shapes replaced.
#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/geometry/shape.hpp"
#include "robot/model/robot_data.hpp"

namespace mmgrasp {
namespace {

using detail::NamedJoint;
using detail::RobotParts;

/// Throws unless T is a finite rotation and translation.
void check_pose(const Pose& T, const std::string& field) {
  checked_pose(T.matrix(), field);
}

std::pair<std::string, std::string> ordered(const std::string& a, const std::string& b) {
  return a < b ? std::make_pair(a, b) : std::make_pair(b, a);
}

NamedJoint fixed_joint(const std::string& name, const std::string& parent, const std::string& child, const Pose& T) {
  NamedJoint named;
  named.joint.name = name;
  named.joint.type = JointType::fixed;
  named.joint.T_parent_joint = T;
  named.parent = parent;
  named.child = child;
  named.place = "joint \"" + name + "\"";
  return named;
}

/// Puts the prefix in front of every name that could clash.
void add_prefix(RobotParts& parts, const std::string& prefix) {
  for (Link& link : parts.links) link.name = prefix + link.name;
  for (NamedJoint& named : parts.joints) {
    for (std::string* name : {&named.joint.name, &named.parent, &named.child}) *name = prefix + *name;
    if (!named.mimic.empty()) named.mimic = prefix + named.mimic;
  }
  for (GroupDescription& group : parts.groups) {
    group.name = prefix + group.name;
    for (std::string& joint : group.joints) joint = prefix + joint;
    for (std::string& link : group.links) link = prefix + link;
    for (std::string* link : {&group.base_link, &group.tip_link})
      if (!link->empty()) *link = prefix + *link;
  }
  for (EndEffectorDescription& effector : parts.end_effectors)
    for (std::string* name : {&effector.name, &effector.group, &effector.parent_link}) *name = prefix + *name;
  GroupStates states;
  for (const auto& [group, by_state] : parts.group_states)
    for (const auto& [state, values] : by_state) {
      auto& renamed = states[prefix + group][state];
      for (const auto& [joint, value] : values) renamed[prefix + joint] = value;
    }
  parts.group_states = std::move(states);
  for (std::string& joint : parts.passive_joints) joint = prefix + joint;
  std::map<std::string, std::string> inertials;
  for (auto& [link, text] : parts.inertials) inertials.emplace(prefix + link, std::move(text));
  parts.inertials = std::move(inertials);
  NamedPairs pairs;
  for (const auto& [pair, reason] : parts.disabled_pairs)
    pairs.emplace(ordered(prefix + pair.first, prefix + pair.second), reason);
  parts.disabled_pairs = std::move(pairs);
  std::set<std::string> left_out;
  for (const std::string& link : parts.shapes_left_out) left_out.insert(prefix + link);
  parts.shapes_left_out = std::move(left_out);
  for (UrdfSource& source : parts.urdfs) {
    source.prefix = prefix + source.prefix;
    if (!source.parent_link.empty()) source.parent_link = prefix + source.parent_link;
  }
  for (AddedLink& link : parts.added_links)
    for (std::string* name : {&link.name, &link.parent_link}) *name = prefix + *name;
}

template <typename T>
void append(std::vector<T>& to, const std::vector<T>& from) {
  to.insert(to.end(), from.begin(), from.end());
}

const std::string& root_name(const RobotParts& parts) {
  return parts.links.front().name;
}

}  // namespace

Robot Robot::mount(const Robot& other, const std::string& parent_link, const Pose& T_parent_other,
                   const std::string& prefix) const {
  link_index(parent_link);
  check_pose(T_parent_other, "T_parent_other");
  RobotParts parts = detail::to_parts(*data_);
  RobotParts mounted = detail::to_parts(*other.data_);
  const std::string used = prefix.empty() ? other.name() + "_" : prefix;
  add_prefix(mounted, used);
  mounted.urdfs.front().parent_link = parent_link;
  mounted.urdfs.front().T_parent_root = T_parent_other;
  append(parts.urdfs, mounted.urdfs);
  append(parts.added_links, mounted.added_links);
  // The mounted robot's links follow in their own order, which starts with its root.
  const std::string mounted_root = root_name(mounted);
  append(parts.links, mounted.links);
  append(parts.joints, mounted.joints);
  append(parts.groups, mounted.groups);
  append(parts.end_effectors, mounted.end_effectors);
  append(parts.passive_joints, mounted.passive_joints);  // its virtual joints end here: its root is fixed now
  parts.inertials.insert(mounted.inertials.begin(), mounted.inertials.end());
  append(parts.report.warnings, mounted.report.warnings);
  append(parts.report.meshes, mounted.report.meshes);
  append(parts.report.missing, mounted.report.missing);
  parts.group_states.insert(mounted.group_states.begin(), mounted.group_states.end());
  parts.disabled_pairs.insert(mounted.disabled_pairs.begin(), mounted.disabled_pairs.end());
  parts.shapes_left_out.insert(mounted.shapes_left_out.begin(), mounted.shapes_left_out.end());
  parts.disabled_pairs.emplace(ordered(parent_link, mounted_root), DisabledReason::adjacent);
  parts.joints.push_back(fixed_joint(used + "mount_joint", parent_link, mounted_root, T_parent_other));
  parts.has_srdf = parts.has_srdf || mounted.has_srdf;
  parts.origin = "mounting \"" + other.name() + "\" on \"" + data_->name + "\" with prefix \"" + used + "\"";
  return Robot(detail::build_robot(parts));
}

Robot Robot::with_link(const std::string& name, const std::string& parent_link, const Pose& T_parent_link,
                       const std::vector<LinkShape>& collisions) const {
  require(!name.empty(), "link name", "\"\"", "must not be empty");
  link_index(parent_link);
  check_pose(T_parent_link, "T_parent_link");
  Link link;
  link.name = name;
  link.collisions = collisions;
  for (const LinkShape& shape : collisions) {
    const std::string field = "link \"" + name + "\" shape";
    check_shape(shape.shape, field);
    check_pose(shape.T_link_shape, field + " pose");
    const std::string kind = shape_kind(shape.shape);
    require(kind != "plane" && kind != "voxels", field, kind,
            "a link's shape must be box, sphere, cylinder, capsule or mesh");
  }
  RobotParts parts = detail::to_parts(*data_);
  parts.origin = "adding link \"" + name + "\" to robot \"" + data_->name + "\"";
  parts.links.push_back(std::move(link));
  parts.added_links.push_back({name, parent_link, T_parent_link, collisions});
  parts.joints.push_back(fixed_joint(name + "_joint", parent_link, name, T_parent_link));
  return Robot(detail::build_robot(parts));
}

}  // namespace mmgrasp
