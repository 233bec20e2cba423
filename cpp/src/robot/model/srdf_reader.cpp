#include "robot/model/srdf_reader.hpp"

#include <tinyxml.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "mmgrasp/core/detail/near_name.hpp"
#include "mmgrasp/core/detail/xml_document.hpp"
#include "mmgrasp/core/error.hpp"

namespace mmgrasp::detail {
namespace {

/// What an SRDF may hold. The last ones are of MoveIt and not read here.
const std::vector<std::string> kKinds = {"virtual_joint",     "passive_joint",      "group",
                                         "group_state",       "end_effector",       "disable_default_collisions",
                                         "enable_collisions", "disable_collisions", "link_sphere_approximation",
                                         "joint_property"};
constexpr std::size_t kMaxGroupNesting = 100;
constexpr std::size_t kMostGroups = 1000;  // each may list every joint

/// A group's members while subgroups are being merged: joint indices, and the ends when one chain gave them.
struct Members {
  std::set<int> joints;  // fixed and mimic ones included
  std::string chain_base, chain_tip;
  bool only_chain = true;
  bool root = false;  // the root link, which no joint carries
};

DisabledReason reason_from(const std::string& text) {
  std::string lower;
  for (const unsigned char c : text) lower += static_cast<char>(std::tolower(c));
  if (lower == "adjacent") return DisabledReason::adjacent;
  if (lower == "never") return DisabledReason::never;
  if (lower == "always") return DisabledReason::always;
  if (lower == "default") return DisabledReason::default_;
  return DisabledReason::user;
}

/// Reads the parts of an SRDF one after another into a robot; what names things that the robot lacks is a warning.
class SrdfReader {
 public:
  SrdfReader(const std::string& text, const std::string& origin, Robot::Data& data) : xml_(text, origin), data_(data) {}

  void read() {
    const TiXmlElement& root = xml_.root();
    if (root.ValueStr() != "robot") xml_.fail(root, "root element of an SRDF must be <robot>");
    read_kinds();
    const auto name = xml_.text(root, "name");
    if (name && *name != data_.name)
      warn(root, "is written for robot \"" + *name + "\", the URDF's is \"" + data_.name + "\"");
    read_virtual_joints();
    read_passive_joints();
    read_groups();
    read_states();
    read_end_effectors();
    read_disabled_pairs();
    report_unknown_links();
    data_.has_srdf = true;
  }

 private:
  /// A URDF in the place of an SRDF would say nothing, and so would a misspelt element.
  void read_kinds() {
    for (const TiXmlElement* e = xml_.root().FirstChildElement(); e; e = e->NextSiblingElement())
      if (e->ValueStr() == "link" || e->ValueStr() == "joint") xml_.fail(*e, "belongs into a URDF: this is no SRDF");
    warn_of_others(xml_.root(), kKinds);
  }

  /// Says each unknown kind of element once in a parent.
  void warn_of_others(const TiXmlElement& parent, const std::vector<std::string>& known) {
    std::set<std::string> said(known.begin(), known.end());
    for (const TiXmlElement* e = parent.FirstChildElement(); e; e = e->NextSiblingElement())
      if (said.insert(e->ValueStr()).second)
        warn(*e, "is ignored: unknown in <" + parent.ValueStr() + ">" + near_miss(e->ValueStr(), known));
  }

  void warn(const TiXmlElement& element, const std::string& what) {
    data_.report.warnings.push_back(xml_.where(element) + ": " + what);
  }

  int find_link(const std::string& name) {
    const auto found = data_.link_by_name.find(name);
    if (found != data_.link_by_name.end()) return found->second;
    ++unknown_links_[name];
    return -1;
  }

  const Joint& joint(int index) const { return data_.joints[index]; }
  /// Joint that carries a link; -1 for the root.
  static int carrier(int link) { return link - 1; }

  /// Joints from base (exclusive) to tip, tip first; nothing when tip does not hang from base.
  std::vector<int> joints_between(int base, int tip) const {
    std::vector<int> path;
    for (int link = tip; link != base; link = joint(path.back()).parent_link) {
      if (carrier(link) < 0) return {};
      path.push_back(carrier(link));
    }
    return path;
  }

  void read_virtual_joints() {
    for (const TiXmlElement* e = xml_.root().FirstChildElement("virtual_joint"); e;
         e = e->NextSiblingElement("virtual_joint"))
      data_.virtual_joints.push_back({xml_.required_text(*e, "name"), xml_.text(*e, "type").value_or("fixed"),
                                      xml_.text(*e, "parent_frame").value_or("world"),
                                      xml_.text(*e, "child_link").value_or(data_.links.front().name)});
  }

  void read_passive_joints() {
    for (const TiXmlElement* e = xml_.root().FirstChildElement("passive_joint"); e;
         e = e->NextSiblingElement("passive_joint")) {
      const std::string name = xml_.required_text(*e, "name");
      if (is_virtual_joint(name)) continue;
      const auto found = data_.joint_by_name.find(name);
      if (found == data_.joint_by_name.end()) {
        warn(*e, "names a joint that the robot lacks");
      } else if (passive_.insert(found->second).second) {
        data_.passive_joints.push_back(name);
      }
    }
  }

  void read_groups() {
    for (const TiXmlElement* e = xml_.root().FirstChildElement("group"); e; e = e->NextSiblingElement("group")) {
      const std::string name = xml_.required_text(*e, "name");
      if (!group_elements_.emplace(name, e).second) {
        warn(*e, "is defined twice, the first is used");
        continue;
      }
      group_order_.push_back(name);
      if (group_order_.size() > kMostGroups)
        xml_.fail(*e, "is one group too many: an SRDF may have at most " + std::to_string(kMostGroups));
    }
    for (const std::string& name : group_order_) {
      std::set<std::string> visiting;
      const Members& members = collect(name, visiting);
      const GroupDescription group = describe(name, members);
      const bool says_something = group_elements_.at(name)->FirstChildElement() != nullptr;
      if (says_something && group.joints.empty() && members.joints.empty())
        warn(*group_elements_.at(name), "none of its joints and links is in the robot, the group is dropped");
      else
        data_.groups.push_back(group);
    }
  }

  /// Each group is worked out once, however often others contain it.
  const Members& collect(const std::string& name, std::set<std::string>& visiting) {
    const auto known = collected_.find(name);
    if (known != collected_.end()) return known->second;
    const TiXmlElement& element = *group_elements_.at(name);
    if (visiting.size() >= kMaxGroupNesting) xml_.fail(element, "subgroups are nested too deeply: at most 100 levels");
    warn_of_others(element, {"joint", "link", "chain", "group"});
    Members members;
    int chains = 0;
    visiting.insert(name);
    for (const TiXmlElement* e = element.FirstChildElement(); e; e = e->NextSiblingElement()) {
      const std::string& kind = e->ValueStr();
      if (kind == "chain") {
        ++chains;
        add_chain(*e, members);
        continue;
      }
      if (kind != "joint" && kind != "link" && kind != "group") continue;
      members.only_chain = false;
      const std::string member = xml_.required_text(*e, "name");
      if (kind == "joint") add_joint(*e, member, members);
      if (kind == "link") add_link(member, members);
      if (kind == "group") add_subgroup(*e, member, visiting, members);
    }
    if (chains != 1) members.only_chain = false;
    visiting.erase(name);
    return collected_.emplace(name, std::move(members)).first->second;
  }

  void add_chain(const TiXmlElement& element, Members& members) {
    const std::string base_name = xml_.required_text(element, "base_link");
    const std::string tip_name = xml_.required_text(element, "tip_link");
    const int base = find_link(base_name), tip = find_link(tip_name);
    if (base < 0 || tip < 0) return;
    const std::vector<int> path = joints_between(base, tip);
    if (path.empty() && base != tip)
      return warn(element, "tip_link = \"" + tip_name + "\" does not hang from base_link = \"" + base_name + "\"");
    members.joints.insert(path.begin(), path.end());
    members.chain_base = base_name;
    members.chain_tip = tip_name;
  }

  void add_joint(const TiXmlElement& element, const std::string& name, Members& members) {
    const auto found = data_.joint_by_name.find(name);
    if (found == data_.joint_by_name.end()) {
      // A virtual joint ties the root to the world; it is the base here, not part of a chain.
      if (!is_virtual_joint(name)) warn(element, "names a joint that the robot lacks");
      return;
    }
    members.joints.insert(found->second);
  }

  bool is_virtual_joint(const std::string& name) const {
    return std::any_of(data_.virtual_joints.begin(), data_.virtual_joints.end(),
                       [&name](const VirtualJoint& joint) { return joint.name == name; });
  }

  void add_link(const std::string& name, Members& members) {
    const int link = find_link(name);
    if (link > 0) members.joints.insert(carrier(link));
    if (link == 0) members.root = true;
  }

  void add_subgroup(const TiXmlElement& element, const std::string& name, std::set<std::string>& visiting,
                    Members& members) {
    if (!group_elements_.count(name)) return warn(element, "names a group that the SRDF lacks");
    if (visiting.count(name)) xml_.fail(element, "subgroups must not contain each other in a circle");
    const Members& other = collect(name, visiting);
    members.joints.insert(other.joints.begin(), other.joints.end());
    members.root = members.root || other.root;
  }

  /// Orders the movable joints from base to tip (breadth-first indices do) and finds the ends if the group is a chain.
  GroupDescription describe(const std::string& name, const Members& members) const {
    GroupDescription group;
    group.name = name;
    if (members.root) group.links.push_back(data_.links.front().name);
    for (const int index : members.joints) group.links.push_back(data_.links[joint(index).child_link].name);
    std::vector<int> movable;
    for (const int index : members.joints)
      if (joint(index).value_index >= 0 && !passive_.count(index)) {
        movable.push_back(index);
        group.joints.push_back(joint(index).name);
      }
    if (members.only_chain) {
      group.base_link = members.chain_base;
      group.tip_link = members.chain_tip;
      return group;
    }
    if (members.joints.empty()) return group;
    // The whole set (with fixed joints) may be a chain; else only its movable joints, as for a hand with one finger
    // joint.
    for (const std::vector<int>& set : {std::vector<int>(members.joints.begin(), members.joints.end()), movable}) {
      if (set.empty() || !on_one_path(set)) continue;
      group.base_link = data_.links[joint(set.front()).parent_link].name;
      group.tip_link = data_.links[joint(set.back()).child_link].name;
      break;
    }
    return group;
  }

  bool on_one_path(const std::vector<int>& joints) const {
    std::vector<int> path = joints_between(0, joint(joints.back()).child_link);
    std::sort(path.begin(), path.end());
    return std::includes(path.begin(), path.end(), joints.begin(), joints.end());
  }

  bool has_group(const std::string& name) const {
    return std::any_of(data_.groups.begin(), data_.groups.end(),
                       [&name](const GroupDescription& group) { return group.name == name; });
  }

  void read_states() {
    for (const TiXmlElement* e = xml_.root().FirstChildElement("group_state"); e;
         e = e->NextSiblingElement("group_state")) {
      const std::string state = xml_.required_text(*e, "name");
      const std::string group = xml_.required_text(*e, "group");
      if (!has_group(group)) {
        warn(*e, "names group \"" + group + "\", which the SRDF lacks or which was dropped");
        continue;
      }
      const auto [entry, is_new] = data_.group_states[group].try_emplace(state);
      if (!is_new) {
        warn(*e, "is defined twice, the first is used");
        continue;
      }
      auto& values = entry->second;
      warn_of_others(*e, {"joint"});
      for (const TiXmlElement* j = e->FirstChildElement("joint"); j; j = j->NextSiblingElement("joint"))
        read_state_value(*j, values);
    }
  }

  void read_state_value(const TiXmlElement& element, std::map<std::string, double>& state) {
    const std::string name = xml_.required_text(element, "name");
    const auto found = data_.joint_by_name.find(name);
    if (found == data_.joint_by_name.end()) return warn(element, "names a joint that the robot lacks");
    const Joint& known = joint(found->second);
    if (known.value_index < 0) return;  // fixed and mimic joints: their values follow from others
    if (known.value_count() != 1) return read_several_values(element, known, state);
    const double value = xml_.required_number(element, "value");
    if (value < known.lower - 1e-3 || value > known.upper + 1e-3)
      warn(element, "value = \"" + number_text(value) + "\" lies outside the joint's limits [" +
                        number_text(known.lower) + ", " + number_text(known.upper) + "]");
    state[name] = value;
  }

  /// x y theta of a planar joint; x y z and a quaternion x y z w of a floating one.
  void read_several_values(const TiXmlElement& element, const Joint& known, std::map<std::string, double>& state) {
    std::vector<double> values = xml_.required_numbers(element, "value", known.type == JointType::planar ? 3 : 7);
    if (known.type == JointType::floating) {
      const Eigen::Vector4d q(values[3], values[4], values[5], values[6]);
      if (!(std::abs(q.norm() - 1) < 1e-3)) xml_.fail(element, "value: its quaternion must be of length 1");
      const Eigen::AngleAxisd turn(Eigen::Quaterniond(q).normalized());
      const Eigen::Vector3d vector = turn.angle() * turn.axis();
      values = {values[0], values[1], values[2], vector[0], vector[1], vector[2]};
    }
    const std::vector<std::string> names = value_names(known);
    for (std::size_t i = 0; i < names.size(); ++i) state[names[i]] = values[i];
  }

  void read_end_effectors() {
    for (const TiXmlElement* e = xml_.root().FirstChildElement("end_effector"); e;
         e = e->NextSiblingElement("end_effector")) {
      EndEffectorDescription effector{xml_.required_text(*e, "name"), xml_.required_text(*e, "group"),
                                      xml_.required_text(*e, "parent_link")};
      if (find_link(effector.parent_link) < 0) continue;
      if (!group_elements_.count(effector.group))
        warn(*e, "names group \"" + effector.group + "\", which the SRDF lacks");
      data_.end_effectors.push_back(std::move(effector));
    }
  }

  void read_disabled_pairs() {
    // Newer SRDFs may start from "all disabled" for a link; enabling pairs again is their counterpart.
    for (const TiXmlElement* e = xml_.root().FirstChildElement("disable_default_collisions"); e;
         e = e->NextSiblingElement("disable_default_collisions")) {
      const int link = find_link(xml_.required_text(*e, "link"));
      for (int other = 0; link >= 0 && other < static_cast<int>(data_.links.size()); ++other)
        if (other != link) data_.disabled_pairs[std::minmax(link, other)] = DisabledReason::default_;
    }
    for_each_pair("enable_collisions",
                  [this](const TiXmlElement&, std::pair<int, int> pair) { data_.disabled_pairs.erase(pair); });
    for_each_pair("disable_collisions", [this](const TiXmlElement& element, std::pair<int, int> pair) {
      data_.disabled_pairs[pair] = reason_from(xml_.text(element, "reason").value_or("user"));
    });
  }

  template <typename Apply>
  void for_each_pair(const char* kind, const Apply& apply) {
    for (const TiXmlElement* e = xml_.root().FirstChildElement(kind); e; e = e->NextSiblingElement(kind)) {
      const int a = find_link(xml_.required_text(*e, "link1"));
      const int b = find_link(xml_.required_text(*e, "link2"));
      if (a >= 0 && b >= 0 && a != b) apply(*e, std::pair<int, int>(std::min(a, b), std::max(a, b)));
    }
  }

  /// One warning a link, not one a mention: SRDFs name a link in dozens of pairs.
  void report_unknown_links() {
    for (const auto& [name, count] : unknown_links_)
      data_.report.warnings.push_back(xml_.origin() + ": link \"" + name + "\" (named " + std::to_string(count) +
                                      (count == 1 ? " time" : " times") +
                                      ") is not in the robot, these entries are ignored");
  }

  XmlDocument xml_;
  Robot::Data& data_;
  std::map<std::string, const TiXmlElement*> group_elements_;
  std::vector<std::string> group_order_;
  std::map<std::string, Members> collected_;
  std::map<std::string, int> unknown_links_;
  std::set<int> passive_;
};

}  // namespace

void read_srdf(const std::string& text, const std::string& origin, Robot::Data& data) {
  SrdfReader(text, origin, data).read();
}

}  // namespace mmgrasp::detail
