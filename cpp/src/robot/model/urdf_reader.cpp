#include "robot/model/urdf_reader.hpp"

#include <tinyxml.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

#include "mmgrasp/core/detail/near_name.hpp"
#include "mmgrasp/core/detail/xml_document.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"

namespace mmgrasp::detail {
namespace {

constexpr double kFallbackVelocity = 1.0;  // [rad/s] or [m/s], for joints whose file gives none
constexpr std::array<JointType, 6> kJointTypes = {JointType::fixed,     JointType::revolute, JointType::continuous,
                                                  JointType::prismatic, JointType::planar,   JointType::floating};

/// Reads a URDF's links and joints by name; build_robot() makes the tree of them.
class UrdfReader {
 public:
  UrdfReader(const std::string& text, const std::string& origin) : xml_(text, origin) {}

  RobotParts read() {
    const TiXmlElement& root = xml_.root();
    if (root.ValueStr() != "robot") xml_.fail(root, "root element of a URDF must be <robot>");
    parts_.origin = xml_.origin();
    parts_.name = xml_.required_text(root, "name");
    for (const TiXmlElement* e = root.FirstChildElement(); e; e = e->NextSiblingElement()) {
      // xacro tags left in the file mean that it was never expanded: links and joints would be missing silently.
      if (e->ValueStr().rfind("xacro:", 0) == 0)
        xml_.fail(*e, "is xacro: expand the file to plain URDF first (Python does for files called .xacro)");
      if (e->ValueStr() == "link") read_link(*e);
      if (e->ValueStr() == "joint") read_joint(*e);
    }
    check_children(root, {"link", "joint"}, {"material", "transmission", "gazebo", "sensor", "ros2_control"});
    return std::move(parts_);
  }

 private:
  void warn(const TiXmlElement& element, const std::string& what) {
    parts_.report.warnings.push_back(xml_.where(element) + ": " + what);
  }

  std::string read_name(const TiXmlElement& element, std::set<std::string>& seen, const char* kind) {
    const std::string name = xml_.required_text(element, "name");
    if (!seen.insert(name).second) xml_.fail(element, std::string(kind) + " name = \"" + name + "\": must be unique");
    return name;
  }

  /// Names among an element's attributes that URDF does not give it; those with a prefix are other programs' own.
  std::vector<std::string> unknown_attributes(const TiXmlElement& element, const std::vector<std::string>& known) {
    std::vector<std::string> unknown;
    for (const TiXmlAttribute* a = element.FirstAttribute(); a; a = a->Next()) {
      const std::string name = a->Name();
      if (name.find(':') == std::string::npos && std::find(known.begin(), known.end(), name) == known.end())
        unknown.push_back(name);
    }
    return unknown;
  }

  /// For elements that place or shape something, where a word not understood would be another robot.
  void only(const TiXmlElement& element, const std::vector<std::string>& known) {
    for (const std::string& name : unknown_attributes(element, known)) {
      std::string rule;
      for (const std::string& other : known) rule += (rule.empty() ? "" : ", ") + other;
      xml_.fail(element, "attribute \"" + name + "\" is unknown: must be one of " + rule + near_miss(name, known));
    }
  }

  /// A misspelt element that places or shapes something would be another robot; others that nobody knows are told once.
  /// `others` are known and not read here. Names with a prefix are other programs' own.
  void check_children(const TiXmlElement& parent, const std::vector<std::string>& read,
                      const std::vector<std::string>& others) {
    for (const TiXmlElement* e = parent.FirstChildElement(); e; e = e->NextSiblingElement()) {
      const std::string& name = e->ValueStr();
      const auto among = [&name](const auto& names) {
        return std::find(names.begin(), names.end(), name) != names.end();
      };
      if (name.find(':') != std::string::npos || among(read) || among(others)) continue;
      const std::string meant = near_miss(name, read);
      if (!meant.empty()) xml_.fail(*e, "is unknown in <" + parent.ValueStr() + ">" + meant);
      if (untold_.insert(parent.ValueStr() + "/" + name).second)
        warn(*e, "is ignored: unknown in <" + parent.ValueStr() + ">");
    }
  }

  Pose read_origin(const TiXmlElement& owner) {
    const TiXmlElement* origin = owner.FirstChildElement("origin");
    if (!origin) return Pose::Identity();
    only(*origin, {"xyz", "rpy"});
    const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
    return pose_from_xyz_rpy(read_vector(*origin, "xyz", zero), read_vector(*origin, "rpy", zero));
  }

  /// Sums and products of what is read must stay finite.
  void check_size(const TiXmlElement& element, const char* attribute, double value) {
    if (!(std::abs(value) <= kLargestLength))
      xml_.fail(element, std::string(attribute) + " = \"" + number_text(value) + "\": must be within 1e6 (damaged?)");
  }

  Eigen::Vector3d read_vector(const TiXmlElement& element, const char* attribute, const Eigen::Vector3d& fallback) {
    const Eigen::Vector3d value = xml_.vector3(element, attribute, fallback);
    for (const double component : value) check_size(element, attribute, component);
    return value;
  }

  double read_positive(const TiXmlElement& element, const char* attribute) {
    const double value = xml_.required_number(element, attribute);
    if (!(value > 0))
      xml_.fail(element, std::string(attribute) + " = \"" + number_text(value) + "\": must be positive");
    check_size(element, attribute, value);
    if (value < kSmallestLength)
      xml_.fail(element, std::string(attribute) + " = \"" + number_text(value) + "\": must be at least 1e-9 m");
    return value;
  }

  void read_link(const TiXmlElement& element) {
    Link link;
    link.name = read_name(element, link_names_, "link");
    check_children(element, {"collision", "inertial"}, {"visual", "contact", "sensor", "gazebo"});
    for (const TiXmlElement* e = element.FirstChildElement("collision"); e; e = e->NextSiblingElement("collision"))
      link.collisions.push_back(read_collision(*e));
    if (const TiXmlElement* inertial = element.FirstChildElement("inertial")) read_inertial(link.name, *inertial);
    parts_.links.push_back(std::move(link));
  }

  /// Nothing here computes with masses: the element is kept as it stands, and bad numbers in it are no reason to refuse
  /// a robot.
  void read_inertial(const std::string& link, const TiXmlElement& element) {
    try {
      read_origin(element);
      for (const TiXmlElement* e = element.FirstChildElement(); e; e = e->NextSiblingElement())
        for (const char* name : {"value", "ixx", "ixy", "ixz", "iyy", "iyz", "izz"}) xml_.number(*e, name, 0);
    } catch (const InvalidInput& error) {
      parts_.report.warnings.push_back(std::string(error.what()) + "; the link's <inertial> is left out");
      return;
    }
    TiXmlPrinter printer;
    printer.SetStreamPrinting();
    element.Accept(&printer);
    parts_.inertials[link] = printer.CStr();
  }

  LinkShape read_collision(const TiXmlElement& element) {
    LinkShape shape;
    check_children(element, {"origin", "geometry"}, {"material", "verbose", "contact_coefficients"});
    shape.T_link_shape = read_origin(element);
    const TiXmlElement* geometry = element.FirstChildElement("geometry");
    if (!geometry) xml_.fail(element, "<geometry> is missing");
    const TiXmlElement* kind = geometry->FirstChildElement();
    if (!kind) xml_.fail(*geometry, "is empty: must hold box, sphere, cylinder, capsule or mesh");
    const std::string& name = kind->ValueStr();
    if (name == "box") {
      shape.shape = read_box(*kind);
    } else if (name == "sphere") {
      only(*kind, {"radius"});
      shape.shape = Sphere{read_positive(*kind, "radius")};
    } else if (name == "cylinder") {
      only(*kind, {"radius", "length"});
      shape.shape = Cylinder{read_positive(*kind, "radius"), read_positive(*kind, "length")};
    } else if (name == "capsule") {
      only(*kind, {"radius", "length"});
      shape.shape = Capsule{read_positive(*kind, "radius"), read_positive(*kind, "length")};
    } else if (name == "mesh") {
      read_mesh(*kind, shape);
    } else {
      xml_.fail(*kind, "shape is unknown: must be box, sphere, cylinder, capsule or mesh");
    }
    return shape;
  }

  Box read_box(const TiXmlElement& element) {
    only(element, {"size"});
    const std::string text = xml_.required_text(element, "size");
    const Eigen::Vector3d size = read_vector(element, "size", Eigen::Vector3d::Zero());
    if (!(size.minCoeff() > 0)) xml_.fail(element, "size = \"" + text + "\": every length must be positive");
    return Box{size};
  }

  void read_mesh(const TiXmlElement& element, LinkShape& shape) {
    only(element, {"filename", "scale"});
    shape.shape = MeshShape{};
    shape.mesh_uri = xml_.required_text(element, "filename");
    shape.mesh_scale = read_vector(element, "scale", Eigen::Vector3d::Ones());
    if (!(shape.mesh_scale.cwiseAbs().minCoeff() > 0))
      xml_.fail(element, "scale = \"" + xml_.required_text(element, "scale") + "\": no axis may be zero");
  }

  void read_joint(const TiXmlElement& element) {
    NamedJoint named;
    Joint& joint = named.joint;
    joint.name = read_name(element, joint_names_, "joint");
    named.place = xml_.where(element);
    joint.type = read_type(element);
    check_children(element, {"parent", "child", "origin", "axis", "limit", "mimic"},
                   {"dynamics", "calibration", "safety_controller"});
    named.parent = read_link_reference(element, "parent");
    named.child = read_link_reference(element, "child");
    joint.T_parent_joint = read_origin(element);
    read_axis(element, joint);
    if (joint.value_count() > 0) read_limits(element, joint);
    if (const TiXmlElement* mimic = element.FirstChildElement("mimic")) read_mimic(element, *mimic, named);
    parts_.joints.push_back(std::move(named));
  }

  JointType read_type(const TiXmlElement& element) {
    const std::string text = xml_.required_text(element, "type");
    for (const JointType type : kJointTypes)
      if (text == to_string(type)) return type;
    xml_.fail(element, "type = \"" + text + "\": must be fixed, revolute, continuous, prismatic, planar or floating");
  }

  std::string read_link_reference(const TiXmlElement& joint, const char* role) {
    const TiXmlElement* reference = joint.FirstChildElement(role);
    if (!reference) xml_.fail(joint, std::string("<") + role + " link=...> is missing");
    return xml_.required_text(*reference, "link");
  }

  void read_axis(const TiXmlElement& element, Joint& joint) {
    const TiXmlElement* axis = element.FirstChildElement("axis");
    if (!axis || joint.type == JointType::fixed || joint.type == JointType::floating) return;
    only(*axis, {"xyz"});
    const Eigen::Vector3d value = read_vector(*axis, "xyz", Eigen::Vector3d::UnitX());
    const double norm = value.norm();
    if (!(norm > 1e-9)) xml_.fail(*axis, "xyz = \"" + xml_.text(*axis, "xyz").value_or("") + "\": must not be zero");
    joint.axis = value / norm;
  }

  void read_limits(const TiXmlElement& element, Joint& joint) {
    const TiXmlElement* limit = element.FirstChildElement("limit");
    joint.velocity = kFallbackVelocity;
    const bool bounded = joint.type == JointType::revolute || joint.type == JointType::prismatic;
    if (!limit) {
      if (bounded)
        xml_.fail(element, std::string("<limit> is missing: a ") + to_string(joint.type) + " joint needs one");
      warn(element, "no velocity limit, 1.0 is used");
      return;
    }
    if (limit->NextSiblingElement("limit")) warn(element, "has more than one <limit>, the first is used");
    for (const std::string& name : unknown_attributes(*limit, {"lower", "upper", "velocity", "effort"}))
      warn(*limit, "attribute \"" + name + "\" is not read");
    if (bounded) {
      joint.lower = xml_.number(*limit, "lower", 0);
      joint.upper = xml_.number(*limit, "upper", 0);
      if (joint.lower > joint.upper)
        xml_.fail(*limit, "lower = \"" + number_text(joint.lower) + "\", upper = \"" + number_text(joint.upper) +
                              "\": lower must not exceed upper");
      // Some files write the largest double for "no limit"; but zero moved into the limits must stay a sane value.
      check_size(*limit, "lower", std::max(0.0, joint.lower));
      check_size(*limit, "upper", std::min(0.0, joint.upper));
    }
    const double velocity = read_not_negative(*limit, "velocity");
    if (velocity > 0) {
      joint.velocity = velocity;
    } else {
      warn(*limit, "velocity is 0 or missing, 1.0 is used");
    }
    const double effort = read_not_negative(*limit, "effort");
    if (effort > 0) joint.effort = effort;
  }

  double read_not_negative(const TiXmlElement& element, const char* attribute) {
    const double value = xml_.number(element, attribute, 0);
    if (value < 0)
      xml_.fail(element, std::string(attribute) + " = \"" + number_text(value) + "\": must not be negative");
    return value;
  }

  void read_mimic(const TiXmlElement& element, const TiXmlElement& mimic, NamedJoint& named) {
    if (named.joint.type == JointType::fixed) return warn(mimic, "is ignored: the joint is fixed");
    if (named.joint.value_count() != 1)
      xml_.fail(element, std::string("a ") + to_string(named.joint.type) + " joint cannot mimic another");
    only(mimic, {"joint", "multiplier", "offset"});
    named.mimic = xml_.required_text(mimic, "joint");
    named.joint.mimic_multiplier = xml_.number(mimic, "multiplier", 1);
    named.joint.mimic_offset = xml_.number(mimic, "offset", 0);
    check_size(mimic, "multiplier", named.joint.mimic_multiplier);
    check_size(mimic, "offset", named.joint.mimic_offset);
  }

  XmlDocument xml_;
  RobotParts parts_;
  std::set<std::string> link_names_, joint_names_, untold_;
};

}  // namespace

RobotParts read_urdf(const std::string& text, const std::string& origin) {
  return UrdfReader(text, origin).read();
}

}  // namespace mmgrasp::detail
