#include <cmath>
#include <sstream>

#include "mmgrasp/core/error.hpp"
#include "robot/robot_data.hpp"
#include "robot/xml_document.hpp"

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

void write_link(std::ostream& out, const Link& link) {
  out << "  <link" << attribute("name", link.name);
  if (link.collisions.empty()) {
    out << "/>\n";
    return;
  }
  out << ">\n";
  for (const LinkShape& shape : link.collisions)
    out << "    <collision>\n      " << origin_text(shape.T_link_shape) << "\n      <geometry>"
        << geometry_text(shape, link.name) << "</geometry>\n    </collision>\n";
  out << "  </link>\n";
}

void write_limit(std::ostream& out, const Joint& joint) {
  out << "    <limit";
  if (joint.type != JointType::continuous)
    out << attribute("lower", number_text(joint.lower)) << attribute("upper", number_text(joint.upper));
  if (std::isfinite(joint.velocity)) out << attribute("velocity", number_text(joint.velocity));
  if (std::isfinite(joint.effort)) out << attribute("effort", number_text(joint.effort));
  out << "/>\n";
}

void write_joint(std::ostream& out, const Joint& joint, const Robot::Data& data) {
  const auto link_name = [&data](int link) { return data.links[static_cast<std::size_t>(link)].name; };
  out << "  <joint" << attribute("name", joint.name) << attribute("type", to_string(joint.type)) << ">\n    "
      << origin_text(joint.T_parent_joint) << "\n    <parent" << attribute("link", link_name(joint.parent_link))
      << "/>\n    <child" << attribute("link", link_name(joint.child_link)) << "/>\n";
  if (joint.type != JointType::fixed && joint.type != JointType::floating)
    out << "    <axis" << attribute("xyz", vector_text(joint.axis)) << "/>\n";
  if (joint.value_count() == 1) write_limit(out, joint);
  if (joint.mimic_joint >= 0)
    out << "    <mimic" << attribute("joint", data.joints[static_cast<std::size_t>(joint.mimic_joint)].name)
        << attribute("multiplier", number_text(joint.mimic_multiplier))
        << attribute("offset", number_text(joint.mimic_offset)) << "/>\n";
  out << "  </joint>\n";
}

void write_group(std::ostream& out, const GroupDescription& group) {
  out << "  <group" << attribute("name", group.name) << ">\n";
  if (!group.tip_link.empty() && !group.base_link.empty()) {
    out << "    <chain" << attribute("base_link", group.base_link) << attribute("tip_link", group.tip_link) << "/>\n";
  } else {
    for (const std::string& joint : group.joints) out << "    <joint" << attribute("name", joint) << "/>\n";
  }
  out << "  </group>\n";
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

}  // namespace

std::string Robot::to_urdf() const {
  std::ostringstream out;
  out << "<?xml version=\"1.0\"?>\n<robot" << attribute("name", data_->name) << ">\n";
  for (const Link& link : data_->links) write_link(out, link);
  for (const Joint& joint : data_->joints) write_joint(out, joint, *data_);
  out << "</robot>\n";
  return out.str();
}

std::string Robot::to_srdf() const {
  std::ostringstream out;
  out << "<?xml version=\"1.0\"?>\n<robot" << attribute("name", data_->name) << ">\n";
  for (const GroupDescription& group : data_->groups) write_group(out, group);
  for (const auto& [group, states] : data_->group_states)
    for (const auto& [state, values] : states) {
      out << "  <group_state" << attribute("name", state) << attribute("group", group) << ">\n";
      for (const auto& [joint, value] : values)
        out << "    <joint" << attribute("name", joint) << attribute("value", number_text(value)) << "/>\n";
      out << "  </group_state>\n";
    }
  for (const EndEffectorDescription& effector : data_->end_effectors)
    out << "  <end_effector" << attribute("name", effector.name) << attribute("group", effector.group)
        << attribute("parent_link", effector.parent_link) << "/>\n";
  for (const auto& [pair, reason] : data_->disabled_pairs)
    out << "  <disable_collisions" << attribute("link1", data_->links[static_cast<std::size_t>(pair.first)].name)
        << attribute("link2", data_->links[static_cast<std::size_t>(pair.second)].name)
        << attribute("reason", reason_text(reason)) << "/>\n";
  out << "</robot>\n";
  return out.str();
}

}  // namespace mmgrasp
