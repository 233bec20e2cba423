#include "mmgrasp/robot/named_configuration.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "mmgrasp/core/detail/near_name.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"

namespace mmgrasp {
namespace {

using State = std::map<std::string, double>;

Eigen::VectorXd reference_of(const JointGroup& group) {
  Eigen::VectorXd q = Eigen::VectorXd::Zero(group.size());
  const std::vector<int>& joints = group.joints();
  int entry = 0;  // within the values of one joint
  for (int i = 0; i < group.size(); ++i) {
    entry = i > 0 && joints[i] == joints[i - 1] ? entry + 1 : 0;
    if (joints[i] >= 0) q[i] = group.reference()[group.robot().joints()[joints[i]].value_index + entry];
  }
  return q;
}

bool names_all(const State& state, const JointGroup& group) {
  for (int i = 0; i < group.size(); ++i) {
    if (group.joints()[i] >= 0 && state.count(group.names()[i]) == 0) return false;
  }
  return true;
}

/// The group's states by name; its own before those of others.
std::map<std::string, State> states_of(const JointGroup& group) {
  std::map<std::string, State> states;
  const auto& all = group.robot().group_states();
  const auto own = all.find(group.name());
  if (own != all.end()) states = own->second;
  for (const auto& [other, by_name] : all) {
    for (const auto& [name, values] : by_name)
      if (names_all(values, group)) states.emplace(name, values);
  }
  return states;
}

}  // namespace

Eigen::VectorXd named_configuration(const JointGroup& group, const std::map<std::string, double>& by_name,
                                    const Eigen::VectorXd& base) {
  if (base.size() > 0) group.check_configuration(base, "base");
  Eigen::VectorXd q = base.size() > 0 ? base : reference_of(group);
  const std::vector<std::string>& names = group.names();
  for (const auto& [name, value] : by_name) {
    const auto column = std::find(names.begin(), names.end(), name);
    if (column == names.end()) {
      throw InvalidInput("joint \"" + name + "\": is none of group \"" + group.name() + "\"" +
                         detail::near_miss(name, names));
    }
    require_number(value, "joint \"" + name + "\"", "rad or m");
    q[column - names.begin()] = value;
  }
  return q;
}

Eigen::VectorXd state_configuration(const JointGroup& group, const std::string& state, const Eigen::VectorXd& base) {
  const std::map<std::string, State> states = states_of(group);
  const auto found = states.find(state);
  if (found == states.end()) {
    std::string known;
    for (const auto& [name, values] : states) known += (known.empty() ? "" : ", ") + name;
    throw InvalidInput("state = \"" + state + "\": group \"" + group.name() + "\" has no such SRDF state; known are " +
                       (known.empty() ? "none" : known));
  }
  State values = found->second;
  const std::vector<std::string>& names = group.names();
  for (auto it = values.begin(); it != values.end();)
    it = std::find(names.begin(), names.end(), it->first) == names.end() ? values.erase(it) : std::next(it);
  return named_configuration(group, values, base);
}

}  // namespace mmgrasp
