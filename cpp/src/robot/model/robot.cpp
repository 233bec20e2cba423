#include "mmgrasp/robot/robot.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/near_name.hpp"
#include "mmgrasp/core/detail/xml_document.hpp"
#include "mmgrasp/core/error.hpp"
#include "robot/model/joint_motion.hpp"
#include "robot/model/robot_data.hpp"

namespace mmgrasp {
namespace {

template <typename Named>
std::vector<std::string> names_of(const std::vector<Named>& items) {
  std::vector<std::string> names;
  for (const Named& item : items) names.push_back(item.name);
  return names;
}

/// "joint" or, for joints with several values, "joint/x": the joint's name and which of its values is meant.
std::pair<std::string, int> split_value_name(const Robot::Data& data, const std::string& name) {
  const std::size_t slash = name.rfind('/');
  if (data.joint_by_name.count(name) || slash == std::string::npos) return {name, 0};
  const auto found = data.joint_by_name.find(name.substr(0, slash));
  if (found == data.joint_by_name.end()) return {name, 0};
  const std::vector<std::string> parts = detail::value_names(data.joints[found->second]);
  const auto part = std::find(parts.begin(), parts.end(), name);
  if (part == parts.end()) return {name, 0};
  return {found->first, static_cast<int>(part - parts.begin())};
}

}  // namespace

Robot::Robot(std::shared_ptr<const Data> data) : data_(std::move(data)) {}

const std::string& Robot::name() const {
  return data_->name;
}
BaseKind Robot::base() const {
  return data_->base;
}
const BaseLimits& Robot::base_limits() const {
  return data_->base_limits;
}
const std::vector<Link>& Robot::links() const {
  return data_->links;
}
const std::vector<Joint>& Robot::joints() const {
  return data_->joints;
}
const RobotReport& Robot::report() const {
  return data_->report;
}

int Robot::link_index(const std::string& name) const {
  const auto found = data_->link_by_name.find(name);
  if (found == data_->link_by_name.end())
    throw InvalidInput("link = \"" + name + "\": robot \"" + data_->name + "\" has no such link" +
                       detail::near_miss(name, names_of(data_->links)));
  return found->second;
}

int Robot::joint_index(const std::string& name) const {
  const auto found = data_->joint_by_name.find(name);
  if (found == data_->joint_by_name.end())
    throw InvalidInput("joint = \"" + name + "\": robot \"" + data_->name + "\" has no such joint" +
                       detail::near_miss(name, names_of(data_->joints)));
  return found->second;
}

bool Robot::has_link(const std::string& name) const {
  return data_->link_by_name.count(name) > 0;
}

int Robot::value_count() const {
  return data_->value_count;
}
Eigen::VectorXd Robot::default_values() const {
  return data_->default_values;
}

Eigen::VectorXd Robot::values(const std::map<std::string, double>& by_name) const {
  constexpr double kSlack = 1e-9;  // printed limits lose their last digit
  Eigen::VectorXd result = data_->default_values;
  for (const auto& [name, value] : by_name) {
    const auto [joint_name, part] = split_value_name(*data_, name);
    const Joint& joint = data_->joints[joint_index(joint_name)];
    const std::string field = "joint \"" + name + "\"";
    if (joint.mimic_joint >= 0)
      throw InvalidInput(field + ": follows joint \"" + data_->joints[joint.mimic_joint].name + "\", set that one");
    if (joint.value_count() == 0) throw InvalidInput(field + ": is fixed, must be a movable joint");
    if (joint.value_count() > 1 && name == joint_name)
      throw InvalidInput(field + ": is " + to_string(joint.type) +
                         ", name one of its values: " + detail::value_names(joint).front() + ", ...");
    require(std::isfinite(value) && value >= joint.lower - kSlack && value <= joint.upper + kSlack, field, value,
            "must lie in [" + detail::number_text(joint.lower) + ", " + detail::number_text(joint.upper) + "]");
    result[joint.value_index + part] = value;
  }
  return result;
}

Poses Robot::link_poses(const Eigen::VectorXd& values, const Pose& T_world_root) const {
  require(values.size() == data_->value_count, "values length", static_cast<double>(values.size()),
          "must be " + std::to_string(data_->value_count));
  Poses T_world_link(data_->links.size());
  T_world_link[0] = T_world_root;
  for (const Joint& joint : data_->joints) {
    double mimicked = 0;
    const double* motion = &mimicked;
    if (joint.mimic_joint >= 0) {
      const Joint& followed = data_->joints[joint.mimic_joint];
      mimicked = joint.mimic_multiplier * values[followed.value_index] + joint.mimic_offset;
    } else if (joint.value_index >= 0) {
      motion = values.data() + joint.value_index;
    }
    T_world_link[joint.child_link] =
        T_world_link[joint.parent_link] * joint.T_parent_joint * detail::joint_motion(joint, motion);
  }
  return T_world_link;
}

const std::vector<GroupDescription>& Robot::groups() const {
  return data_->groups;
}
const std::vector<EndEffectorDescription>& Robot::end_effectors() const {
  return data_->end_effectors;
}
const GroupStates& Robot::group_states() const {
  return data_->group_states;
}
const std::vector<std::string>& Robot::passive_joints() const {
  return data_->passive_joints;
}
bool Robot::has_srdf() const {
  return data_->has_srdf;
}

bool Robot::pair_disabled(int link_a, int link_b) const {
  return link_a == link_b || data_->disabled_pairs.count(std::minmax(link_a, link_b)) > 0;
}

const std::map<std::pair<int, int>, DisabledReason>& Robot::disabled_pairs() const {
  return data_->disabled_pairs;
}

Robot Robot::with_disabled_pairs(std::map<std::pair<int, int>, DisabledReason> pairs) const {
  const int count = static_cast<int>(data_->links.size());
  for (const auto& entry : pairs) {
    const auto [first, second] = entry.first;
    require(first >= 0 && first < second && second < count, "disabled pair",
            "(" + std::to_string(first) + ", " + std::to_string(second) + ")",
            "must be two link indices with first < second < " + std::to_string(count));
  }
  auto data = std::make_shared<Data>(*data_);
  data->disabled_pairs = std::move(pairs);
  return Robot(std::move(data));
}

}  // namespace mmgrasp
