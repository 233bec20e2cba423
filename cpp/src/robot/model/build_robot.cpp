// From what URDF and SRDF say to a checked tree of links and joints.
#include <algorithm>
#include <cmath>
#include <deque>
#include <set>

#include "mmgrasp/core/detail/near_name.hpp"
#include "mmgrasp/core/error.hpp"
#include "robot/model/robot_data.hpp"

namespace mmgrasp::detail {
namespace {

constexpr std::size_t kMostLinks = 2000;  // a robot keeps pairs of links, so its size grows with the square

using NameIndex = std::unordered_map<std::string, int>;

std::vector<std::string> link_names(const RobotParts& parts) {
  std::vector<std::string> names;
  for (const Link& link : parts.links) names.push_back(link.name);
  return names;
}

NameIndex index_links(const RobotParts& parts) {
  NameIndex index;
  for (const Link& link : parts.links)
    if (!index.emplace(link.name, static_cast<int>(index.size())).second)
      throw InvalidInput(parts.origin + ": link name = \"" + link.name + "\": must be unique");
  return index;
}

NameIndex index_joints(const RobotParts& parts) {
  NameIndex index;
  for (const NamedJoint& named : parts.joints)
    if (!index.emplace(named.joint.name, static_cast<int>(index.size())).second)
      throw InvalidInput(named.place + ": joint name = \"" + named.joint.name + "\": must be unique");
  return index;
}

int link_of(const NameIndex& links, const RobotParts& parts, const NamedJoint& joint, const char* role,
            const std::string& name) {
  const auto found = links.find(name);
  if (found == links.end())
    throw InvalidInput(joint.place + ": " + role + " link = \"" + name + "\": must name a link of the robot" +
                       near_miss(name, link_names(parts)));
  return found->second;
}

/// The tree over indices into the parts.
struct Tree {
  int root = -1;
  std::vector<int> parent_joint;               // per link
  std::vector<std::vector<int>> child_joints;  // per link, in the file's order
  std::vector<int> joint_parent, joint_child;  // per joint
};

int find_root(const RobotParts& parts, const Tree& tree) {
  std::vector<std::string> roots;
  int root = -1;
  for (std::size_t i = 0; i < parts.links.size(); ++i) {
    if (tree.parent_joint[i] >= 0) continue;
    if (root < 0) root = static_cast<int>(i);
    roots.push_back("\"" + parts.links[i].name + "\"");
  }
  if (roots.empty())
    throw InvalidInput(parts.origin + ": joints form a cycle: exactly one link must have no parent joint");
  if (roots.size() > 1) {
    std::string list;
    for (std::size_t i = 0; i < std::min<std::size_t>(roots.size(), 5); ++i) list += (i ? ", " : "") + roots[i];
    if (roots.size() > 5) list += ", ...";
    throw InvalidInput(parts.origin + ": links without a parent joint = " + list +
                       ": exactly one link must be the root");
  }
  return root;
}

Tree build_tree(const RobotParts& parts, const NameIndex& links) {
  Tree tree;
  tree.parent_joint.assign(parts.links.size(), -1);
  tree.child_joints.resize(parts.links.size());
  for (std::size_t j = 0; j < parts.joints.size(); ++j) {
    const NamedJoint& named = parts.joints[j];
    const int parent = link_of(links, parts, named, "parent", named.parent);
    const int child = link_of(links, parts, named, "child", named.child);
    if (parent == child)
      throw InvalidInput(named.place + ": parent and child = \"" + named.child + "\": must differ (cycle)");
    int& known = tree.parent_joint[child];
    if (known >= 0)
      throw InvalidInput(named.place + ": child link = \"" + named.child + "\": already carried by joint \"" +
                         parts.joints[known].joint.name + "\", must have one parent joint");
    known = static_cast<int>(j);
    tree.joint_parent.push_back(parent);
    tree.joint_child.push_back(child);
    tree.child_joints[parent].push_back(static_cast<int>(j));
  }
  tree.root = find_root(parts, tree);
  return tree;
}

/// Links of the parts in breadth-first order. Links that the root does not reach sit on a cycle.
std::vector<int> breadth_first(const RobotParts& parts, const Tree& tree) {
  std::vector<int> order{tree.root};
  for (std::size_t head = 0; head < order.size(); ++head)
    for (const int joint : tree.child_joints[order[head]]) order.push_back(tree.joint_child[joint]);
  if (order.size() < parts.links.size()) {
    std::vector<bool> reached(parts.links.size(), false);
    for (const int link : order) reached[link] = true;
    const auto first = std::find(reached.begin(), reached.end(), false) - reached.begin();
    throw InvalidInput(parts.origin + ": link \"" + parts.links[first].name +
                       "\" hangs on a cycle of joints: every link must hang from the root \"" +
                       parts.links[tree.root].name + "\"");
  }
  return order;
}

/// Follows chains of mimic joints to the joint that really moves and folds multipliers and offsets together.
void resolve_mimics(const RobotParts& parts, const NameIndex& part_joints, Robot::Data& data) {
  std::vector<std::string> names;
  for (const NamedJoint& named : parts.joints) names.push_back(named.joint.name);
  for (Joint& joint : data.joints) {
    const NamedJoint* step = &parts.joints[part_joints.at(joint.name)];
    if (step->mimic.empty()) continue;
    const std::string& place = step->place;
    double multiplier = 1, offset = 0;
    for (std::size_t hops = 0; !step->mimic.empty(); ++hops) {
      if (hops > parts.joints.size())
        throw InvalidInput(place + ": mimic joint = \"" + step->mimic +
                           "\": mimic joints must not follow each other in a circle");
      const auto found = part_joints.find(step->mimic);
      if (found == part_joints.end())
        throw InvalidInput(place + ": mimic joint = \"" + step->mimic + "\": must name a joint" +
                           near_miss(step->mimic, names));
      offset += multiplier * step->joint.mimic_offset;
      multiplier *= step->joint.mimic_multiplier;
      step = &parts.joints[found->second];
    }
    if (step->joint.value_count() != 1)
      throw InvalidInput(place + ": mimic joint = \"" + step->joint.name + "\": is " + to_string(step->joint.type) +
                         ", must be a joint with one value");
    if (!(std::abs(multiplier) < 1e12 && std::abs(offset) < 1e12))
      throw InvalidInput(place + ": mimic multipliers and offsets multiply to above 1e12 (damaged?)");
    joint.mimic_joint = data.joint_by_name.at(step->joint.name);
    joint.mimic_multiplier = multiplier;
    joint.mimic_offset = offset;
  }
}

void number_values(Robot::Data& data) {
  std::vector<double> defaults;
  for (Joint& joint : data.joints) {
    joint.value_index = -1;
    if (joint.mimic_joint >= 0 || joint.value_count() == 0) continue;
    joint.value_index = static_cast<int>(defaults.size());
    for (int i = 0; i < joint.value_count(); ++i) defaults.push_back(std::clamp(0.0, joint.lower, joint.upper));
  }
  data.value_count = static_cast<int>(defaults.size());
  data.default_values = Eigen::Map<const Eigen::VectorXd>(defaults.data(), static_cast<Eigen::Index>(defaults.size()));
}

/// First link of each link's rigid body: links joined by fixed joints share it.
std::vector<int> rigid_bodies(const Robot::Data& data) {
  std::vector<int> body(data.links.size(), 0);
  for (const Joint& joint : data.joints)
    body[joint.child_link] = joint.type == JointType::fixed ? body[joint.parent_link] : joint.child_link;
  return body;
}

}  // namespace

std::set<std::pair<int, int>> adjacent_pairs(const Robot::Data& data) {
  std::set<std::pair<int, int>> pairs;
  const auto is_bare = [&data](int link) {
    const Link& l = data.links[link];
    return l.collisions.empty() && data.shapes_left_out.count(l.name) == 0;
  };
  const auto disable = [&pairs](int a, int b) {
    if (a != b) pairs.emplace(std::minmax(a, b));
  };
  for (const Joint& joint : data.joints) {
    disable(joint.parent_link, joint.child_link);
    // Links without shapes (flanges, frames) join their neighbours as if these touched directly.
    int above = joint.parent_link;
    while (above > 0 && is_bare(above)) above = data.joints[above - 1].parent_link;
    disable(above, joint.child_link);
  }
  // Two links of one rigid body never move against each other: whether they touch is no matter of configuration.
  const std::vector<int> body = rigid_bodies(data);
  for (std::size_t a = 0; a < body.size(); ++a)
    for (std::size_t b = a + 1; b < body.size(); ++b)
      if (body[a] == body[b]) disable(static_cast<int>(a), static_cast<int>(b));
  return pairs;
}

std::shared_ptr<Robot::Data> build_robot(const RobotParts& parts) {
  if (parts.links.empty())
    throw InvalidInput(parts.origin + ": robot \"" + parts.name + "\" has no <link>: needs at least one");
  if (parts.links.size() > kMostLinks)
    throw InvalidInput(parts.origin + ": robot \"" + parts.name + "\" has " + std::to_string(parts.links.size()) +
                       " links: must have at most " + std::to_string(kMostLinks));
  const NameIndex part_links = index_links(parts);
  const NameIndex part_joints = index_joints(parts);
  const Tree tree = build_tree(parts, part_links);
  const std::vector<int> order = breadth_first(parts, tree);

  auto data = std::make_shared<Robot::Data>();
  static_cast<RobotContent&>(*data) = parts;
  for (const int old_link : order) {
    Link link = parts.links[old_link];
    const int index = static_cast<int>(data->links.size());
    link.child_joints.clear();
    link.parent_joint = index - 1;
    data->link_by_name.emplace(link.name, index);
    data->links.push_back(std::move(link));
    const int old_joint = tree.parent_joint[old_link];
    if (old_joint < 0) continue;
    const NamedJoint& named = parts.joints[old_joint];
    Joint joint = named.joint;
    joint.parent_link = data->link_by_name.at(named.parent);
    joint.child_link = index;
    data->links[joint.parent_link].child_joints.push_back(index - 1);
    data->joint_by_name.emplace(joint.name, index - 1);
    data->joints.push_back(std::move(joint));
  }
  resolve_mimics(parts, part_joints, *data);
  number_values(*data);
  for (const auto& [names, reason] : parts.disabled_pairs) {
    const auto a = data->link_by_name.find(names.first), b = data->link_by_name.find(names.second);
    if (a != data->link_by_name.end() && b != data->link_by_name.end() && a != b)
      data->disabled_pairs.emplace(std::minmax(a->second, b->second), reason);
  }
  for (const auto& pair : adjacent_pairs(*data)) data->disabled_pairs.emplace(pair, DisabledReason::adjacent);
  return data;
}

RobotParts to_parts(const Robot::Data& data) {
  RobotParts parts;
  static_cast<RobotContent&>(parts) = data;
  parts.origin = "robot \"" + data.name + "\"";
  parts.links = data.links;
  for (const Joint& joint : data.joints) {
    NamedJoint named;
    named.joint = joint;
    named.parent = data.links[joint.parent_link].name;
    named.child = data.links[joint.child_link].name;
    if (joint.mimic_joint >= 0) named.mimic = data.joints[joint.mimic_joint].name;
    named.place = parts.origin + ": joint \"" + joint.name + "\"";
    parts.joints.push_back(std::move(named));
  }
  for (const auto& [pair, reason] : data.disabled_pairs) {
    const std::string& a = data.links[pair.first].name;
    const std::string& b = data.links[pair.second].name;
    parts.disabled_pairs.emplace(std::minmax(a, b), reason);
  }
  return parts;
}

}  // namespace mmgrasp::detail
