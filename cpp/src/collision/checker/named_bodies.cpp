#include "mmgrasp/collision/detail/named_bodies.hpp"

#include <algorithm>

#include "mmgrasp/core/detail/near_name.hpp"
#include "mmgrasp/core/error.hpp"

namespace mmgrasp::detail {
namespace {

std::vector<std::string> known_names(const Robot& robot, const World& world) {
  std::vector<std::string> names;
  for (const Link& link : robot.links()) names.push_back(link.name);
  for (const GroupDescription& group : robot.groups()) names.push_back(group.name);
  for (const auto& [name, object] : world.objects()) names.push_back(name);
  for (const auto& [name, object] : world.attached()) names.push_back(name);
  for (const auto& [name, obstacle] : world.fields()) names.push_back(name);
  return names;
}

bool bears(const Robot& robot, const World& world, const std::string& name) {
  return robot.has_link(name) || world.has(name);
}

}  // namespace

std::vector<std::string> links_of(const Robot& robot, const GroupDescription& group) {
  std::vector<std::string> links = group.links;
  const std::set<std::string> named(links.begin(), links.end());
  const auto carries_named = [&](int joint) {
    return named.count(robot.links()[robot.joints()[joint].child_link].name) > 0;
  };
  for (const Joint& joint : robot.joints()) {
    const std::string& link = robot.links()[joint.child_link].name;
    if (joint.mimic_joint >= 0 && named.count(link) == 0 && carries_named(joint.mimic_joint)) links.push_back(link);
  }
  return links;
}

std::vector<std::string> bodies_named(const Robot& robot, const World& world, const std::string& name,
                                      const std::string& field) {
  std::vector<std::string> bodies;
  if (bears(robot, world, name)) bodies.push_back(name);
  bool known = !bodies.empty();
  for (const GroupDescription& group : robot.groups()) {
    if (group.name != name) continue;
    known = true;
    const std::vector<std::string> links = links_of(robot, group);
    bodies.insert(bodies.end(), links.begin(), links.end());
  }
  if (!known) {
    throw InvalidInput(field + " = '" + name + "': is no link or group of robot '" + robot.name() +
                       "' and no object of the world" + near_miss(name, known_names(robot, world)));
  }
  return bodies;
}

AllowedPairs::AllowedPairs(const Robot& robot, const World& world) {
  for (const auto& [a, b] : world.allowed()) {
    const std::string field = "allowed pair ('" + a + "', '" + b + "')";
    const std::vector<std::string> others = bodies_named(robot, world, b, field);
    for (const std::string& one : bodies_named(robot, world, a, field)) {
      for (const std::string& other : others) pairs_.insert(std::minmax(one, other));
    }
  }
}

bool AllowedPairs::operator()(const std::string& a, const std::string& b) const {
  return !pairs_.empty() && pairs_.count(std::minmax(a, b)) > 0;
}

World objects_never_touched(const Robot& robot, const World& world, const std::set<std::string>& bodies) {
  const AllowedPairs allowed(robot, world);
  const auto never_touched = [&](const std::string& object) {
    return std::none_of(bodies.begin(), bodies.end(), [&](const std::string& body) { return allowed(body, object); });
  };
  World out;
  for (const auto& [name, object] : world.objects())
    if (never_touched(name)) out.add(name, object);
  for (const auto& [name, obstacle] : world.fields())
    if (never_touched(name)) out.add_field(name, obstacle);
  return out;
}

BodyPadding::BodyPadding(const Robot& robot, const World& world) : padding_(world.padding()) {
  for (const auto& [name, padding] : padding_.by_name) {
    for (const std::string& body : bodies_named(robot, world, name, "padding.by_name")) {
      double& kept = by_body_.emplace(body, padding).first->second;
      kept = std::max(kept, padding);
    }
  }
  for (const auto& [name, padding] : padding_.by_name) {
    if (bears(robot, world, name)) by_body_[name] = padding;
  }
}

double BodyPadding::of(const std::string& name, double otherwise) const {
  const auto own = by_body_.find(name);
  return own == by_body_.end() ? otherwise : own->second;
}

}  // namespace mmgrasp::detail
