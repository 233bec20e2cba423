// Robot::to_urdf and to_srdf.
#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

#include "mmgrasp/core/detail/xml_document.hpp"
#include "mmgrasp/core/error.hpp"
#include "robot/model/robot_data.hpp"

namespace mmgrasp {
namespace {

using detail::number_text;
using detail::xml_escape;

std::string vector_text(const Eigen::Vector3d& v) {
  return number_text(v[0]) + " " + number_text(v[1]) + " " + number_text(v[2]);
}

std::string attribute(const char* name, const std::string& value) {
  return std::string(" ") + name + "=\"" + xml_escape(value) + "\"";
}

std::string origin_text(const Pose& T) {
  return "<origin" + attribute("xyz", vector_text(T.translation())) +
         attribute("rpy", vector_text(rpy_from_rotation(T.linear()))) + "/>";
}

std::string geometry_text(const LinkShape& shape, const std::string& link) {
  if (const auto* box = std::get_if<Box>(&shape.shape))
    return "<box" + attribute("size", vector_text(box->size)) + "/>";
  if (const auto* sphere = std::get_if<Sphere>(&shape.shape))
    return "<sphere" + attribute("radius", number_text(sphere->radius)) + "/>";
  const auto round = [](const char* kind, double radius, double length) {
    return std::string("<") + kind + attribute("radius", number_text(radius)) +
           attribute("length", number_text(length)) + "/>";
  };
  if (const auto* cylinder = std::get_if<Cylinder>(&shape.shape))
    return round("cylinder", cylinder->radius, cylinder->length);
  if (const auto* capsule = std::get_if<Capsule>(&shape.shape))
    return round("capsule", capsule->radius, capsule->length);
  if (std::holds_alternative<MeshShape>(shape.shape) && !shape.mesh_path.empty())
    return "<mesh" + attribute("filename", shape.mesh_path) + attribute("scale", vector_text(shape.mesh_scale)) + "/>";
  throw InvalidInput("link \"" + link + "\": a " + shape_kind(shape.shape) +
                     " that came from no file cannot be written to a URDF: give it a mesh_path or use a primitive");
}

void write_link(std::ostream& out, const Link& link, const std::map<std::string, std::string>& inertials) {
  const auto inertial = inertials.find(link.name);
  out << "  <link" << attribute("name", link.name);
  if (link.collisions.empty() && inertial == inertials.end()) {
    out << "/>\n";
    return;
  }
  out << ">\n";
  if (inertial != inertials.end()) out << "    " << inertial->second << "\n";
  for (const LinkShape& shape : link.collisions)
    out << "    <collision>\n      " << origin_text(shape.T_link_shape) << "\n      <geometry>"
        << geometry_text(shape, link.name) << "</geometry>\n    </collision>\n";
  out << "  </link>\n";
}

void write_limit(std::ostream& out, const Joint& joint) {
  out << "    <limit";
  if (joint.type != JointType::continuous && joint.value_count() == 1)
    out << attribute("lower", number_text(joint.lower)) << attribute("upper", number_text(joint.upper));
  if (std::isfinite(joint.velocity)) out << attribute("velocity", number_text(joint.velocity));
  if (std::isfinite(joint.effort)) out << attribute("effort", number_text(joint.effort));
  out << "/>\n";
}

void write_joint(std::ostream& out, const Joint& joint, const Robot::Data& data) {
  const auto link_name = [&data](int link) { return data.links[link].name; };
  out << "  <joint" << attribute("name", joint.name) << attribute("type", to_string(joint.type)) << ">\n    "
      << origin_text(joint.T_parent_joint) << "\n    <parent" << attribute("link", link_name(joint.parent_link))
      << "/>\n    <child" << attribute("link", link_name(joint.child_link)) << "/>\n";
  if (joint.type != JointType::fixed && joint.type != JointType::floating)
    out << "    <axis" << attribute("xyz", vector_text(joint.axis)) << "/>\n";
  if (joint.type != JointType::fixed) write_limit(out, joint);
  if (joint.mimic_joint >= 0)
    out << "    <mimic" << attribute("joint", data.joints[joint.mimic_joint].name)
        << attribute("multiplier", number_text(joint.mimic_multiplier))
        << attribute("offset", number_text(joint.mimic_offset)) << "/>\n";
  out << "  </joint>\n";
}

/// Joints from a group's base to its tip, base first.
std::vector<const Joint*> path_of(const GroupDescription& group, const Robot::Data& data) {
  std::vector<const Joint*> path;
  const int base = data.link_by_name.at(group.base_link);
  for (int link = data.link_by_name.at(group.tip_link); link != base; link = path.back()->parent_link)
    path.push_back(&data.joints[link - 1]);
  std::reverse(path.begin(), path.end());
  return path;
}

/// A chain when its ends say which joints are meant; else joint by joint, with the joints without values of their own
/// at either end, so that reading finds the same ends.
void write_group(std::ostream& out, const GroupDescription& group, const Robot::Data& data) {
  out << "  <group" << attribute("name", group.name) << ">\n";
  std::vector<std::string> written = group.joints;
  bool chain = !group.tip_link.empty() && !group.base_link.empty();
  if (chain) {
    const std::vector<const Joint*> path = path_of(group, data);
    const std::set<std::string> passive(data.passive_joints.begin(), data.passive_joints.end());
    std::vector<std::string> driven;
    for (const Joint* joint : path)
      if (joint->value_index >= 0 && !passive.count(joint->name)) driven.push_back(joint->name);
    std::set<std::string> on_path;
    for (const Joint* joint : path) on_path.insert(data.links[joint->child_link].name);
    chain = driven == group.joints && on_path == std::set<std::string>(group.links.begin(), group.links.end());
    if (!chain && path.front()->value_index < 0) written.insert(written.begin(), path.front()->name);
    if (!chain && path.back()->value_index < 0) written.push_back(path.back()->name);
  }
  if (chain) {
    out << "    <chain" << attribute("base_link", group.base_link) << attribute("tip_link", group.tip_link) << "/>\n";
  } else {
    for (const std::string& joint : written) out << "    <joint" << attribute("name", joint) << "/>\n";
    for (const std::string& link : group.links) {
      const int carrier = data.links[data.link_by_name.at(link)].parent_joint;
      const bool carried = carrier >= 0 && std::count(written.begin(), written.end(), data.joints[carrier].name) > 0;
      if (!carried) out << "    <link" << attribute("name", link) << "/>\n";
    }
  }
  out << "  </group>\n";
}

/// The value attribute of a joint in a group state; see the reader for joints with several values.
std::string state_text(const Joint& joint, const std::map<std::string, double>& values) {
  const std::vector<std::string> names = detail::value_names(joint);
  if (joint.type != JointType::floating) {
    std::string text;
    for (const std::string& name : names) text += (text.empty() ? "" : " ") + number_text(values.at(name));
    return text;
  }
  const auto vector = [&](std::size_t first) {
    return Eigen::Vector3d(values.at(names[first]), values.at(names[first + 1]), values.at(names[first + 2]));
  };
  const Eigen::Vector3d turn = vector(3);
  const double angle = turn.norm();
  const Eigen::Quaterniond q(
      Eigen::AngleAxisd(angle, angle > 0 ? Eigen::Vector3d(turn / angle) : Eigen::Vector3d::UnitX()));
  return vector_text(vector(0)) + " " + vector_text(q.vec()) + " " + number_text(q.w());
}

void write_states(std::ostream& out, const Robot::Data& data) {
  for (const auto& [group, states] : data.group_states)
    for (const auto& [state, values] : states) {
      out << "  <group_state" << attribute("name", state) << attribute("group", group) << ">\n";
      for (const Joint& joint : data.joints)
        if (joint.value_index >= 0 && values.count(detail::value_names(joint).front()))
          out << "    <joint" << attribute("name", joint.name) << attribute("value", state_text(joint, values))
              << "/>\n";
      out << "  </group_state>\n";
    }
}

const char* reason_text(DisabledReason reason) {
  switch (reason) {
    case DisabledReason::adjacent:
      return "Adjacent";
    case DisabledReason::never:
      return "Never";
    case DisabledReason::always:
      return "Always";
    case DisabledReason::user:
      return "User";
    case DisabledReason::default_:
      return "Default";
  }
  return "User";
}

void write_pairs(std::ostream& out, const Robot::Data& data) {
  const auto links = [&data](const std::pair<int, int>& pair) {
    return attribute("link1", data.links[pair.first].name) + attribute("link2", data.links[pair.second].name);
  };
  // Neighbours count as disabled unless the file says otherwise.
  for (const auto& pair : detail::adjacent_pairs(data))
    if (!data.disabled_pairs.count(pair)) out << "  <enable_collisions" << links(pair) << "/>\n";
  for (const auto& [pair, reason] : data.disabled_pairs)
    out << "  <disable_collisions" << links(pair) << attribute("reason", reason_text(reason)) << "/>\n";
}

}  // namespace

std::string Robot::to_urdf() const {
  std::ostringstream out;
  out << "<?xml version=\"1.0\"?>\n<robot" << attribute("name", data_->name) << ">\n";
  for (const Link& link : data_->links) write_link(out, link, data_->inertials);
  for (const Joint& joint : data_->joints) write_joint(out, joint, *data_);
  out << "</robot>\n";
  return out.str();
}

std::string Robot::to_srdf() const {
  std::ostringstream out;
  out << "<?xml version=\"1.0\"?>\n<robot" << attribute("name", data_->name) << ">\n";
  for (const detail::VirtualJoint& joint : data_->virtual_joints)
    out << "  <virtual_joint" << attribute("name", joint.name) << attribute("type", joint.type)
        << attribute("parent_frame", joint.parent_frame) << attribute("child_link", joint.child_link) << "/>\n";
  for (const std::string& joint : data_->passive_joints)
    out << "  <passive_joint" << attribute("name", joint) << "/>\n";
  for (const GroupDescription& group : data_->groups) write_group(out, group, *data_);
  write_states(out, *data_);
  for (const EndEffectorDescription& effector : data_->end_effectors)
    out << "  <end_effector" << attribute("name", effector.name) << attribute("group", effector.group)
        << attribute("parent_link", effector.parent_link) << "/>\n";
  write_pairs(out, *data_);
  out << "</robot>\n";
  return out.str();
}

}  // namespace mmgrasp
