#include "same_robot.hpp"

#include <string>
#include <vector>

#include "mmgrasp/core/error.hpp"

namespace mmgrasp::python {
namespace {

template <typename Item>
std::string name_difference(const std::vector<Item>& own, const std::vector<Item>& given, const std::string& what) {
  if (own.size() != given.size()) {
    return "it has " + std::to_string(own.size()) + " " + what + "s, not " + std::to_string(given.size());
  }
  for (std::size_t i = 0; i < own.size(); ++i) {
    if (own[i].name != given[i].name) return "it has " + what + " '" + own[i].name + "', not '" + given[i].name + "'";
  }
  return "";
}

bool same_motion(const Joint& a, const Joint& b) {
  return a.type == b.type && a.parent_link == b.parent_link && a.T_parent_joint.matrix() == b.T_parent_joint.matrix() &&
         a.axis == b.axis && a.mimic_joint == b.mimic_joint && a.mimic_multiplier == b.mimic_multiplier &&
         a.mimic_offset == b.mimic_offset;
}

/// The first thing in which the group's robot differs from the one given.
std::string difference(const Robot& own, const Robot& given) {
  if (own.base() != given.base())
    return std::string("its base is ") + to_string(own.base()) + ", not " + to_string(given.base());
  std::string names = name_difference(own.joints(), given.joints(), "joint");
  if (names.empty()) names = name_difference(own.links(), given.links(), "link");
  if (!names.empty()) return names;
  for (std::size_t i = 0; i < own.joints().size(); ++i) {
    const Joint &a = own.joints()[i], &b = given.joints()[i];
    if (!same_motion(a, b)) return "joint '" + a.name + "' has another type, origin or axis";
    if (a.lower != b.lower || a.upper != b.upper || a.velocity != b.velocity || a.effort != b.effort)
      return "joint '" + a.name + "' has other limits";
  }
  if (own.disabled_pairs() != given.disabled_pairs()) return "other pairs of its links are not checked for collisions";
  return "shapes of its links or limits of its base differ";
}

}  // namespace

void check_same_robot(const Robot& robot, const JointGroup& group) {
  if (group.robot().hash() == robot.hash()) return;
  throw InvalidInput("group: belongs to another robot ('" + group.robot().name() + "') than the one given ('" +
                     robot.name() + "'): " + difference(group.robot(), robot));
}

}  // namespace mmgrasp::python
