#include "mmgrasp/robot/detail/robot_record.hpp"

#include "mmgrasp/core/error.hpp"
#include "robot/model/robot_data.hpp"

namespace mmgrasp::detail {
namespace {

/// A number of one of so many, or -1.
bool is_one_of(int number, std::size_t count) {
  return number >= -1 && number < static_cast<int>(count);
}

bool goes_up_to_the_root(const RobotRecord& record, int link) {
  for (std::size_t steps = 0; steps <= record.links.size(); ++steps) {
    const int joint = record.links[link].parent_joint;
    if (joint < 0) return true;
    link = record.joints[joint].parent_link;
  }
  return false;
}

/// What indices lead to must be there: records come from files.
bool is_whole(const RobotRecord& record) {
  const std::size_t links = record.links.size(), joints = record.joints.size();
  const auto values = static_cast<std::size_t>(record.default_values.size());
  for (const Link& link : record.links)
    if (!is_one_of(link.parent_joint, joints)) return false;
  for (const Joint& j : record.joints) {
    const bool has_ends = j.parent_link >= 0 && j.child_link >= 0;
    if (!has_ends || !is_one_of(j.parent_link, links) || !is_one_of(j.child_link, links)) return false;
    if (!is_one_of(j.mimic_joint, joints) || !is_one_of(j.value_index, values)) return false;
  }
  for (const auto& [pair, reason] : record.disabled_pairs)
    if (!is_one_of(pair.first, links) || !is_one_of(pair.second, links)) return false;
  for (std::size_t i = 0; i < links; ++i)
    if (!goes_up_to_the_root(record, static_cast<int>(i))) return false;
  return links > 0;
}

}  // namespace

RobotRecord record_of(const Robot& robot) {
  const Robot::Data& data = robot.data();
  return {data, data.links, data.joints, data.disabled_pairs, data.default_values};
}

Robot robot_of(RobotRecord record) {
  if (!is_whole(record)) throw InvalidInput("record of a robot: names links, joints or values that it does not hold");
  auto data = std::make_shared<Robot::Data>();
  static_cast<RobotContent&>(*data) = std::move(record.content);
  data->links = std::move(record.links);
  data->joints = std::move(record.joints);
  data->disabled_pairs = std::move(record.disabled_pairs);
  for (std::size_t i = 0; i < data->links.size(); ++i)
    data->link_by_name.emplace(data->links[i].name, static_cast<int>(i));
  for (std::size_t i = 0; i < data->joints.size(); ++i)
    data->joint_by_name.emplace(data->joints[i].name, static_cast<int>(i));
  data->value_count = static_cast<int>(record.default_values.size());
  data->default_values = std::move(record.default_values);
  return Robot(std::move(data));
}

}  // namespace mmgrasp::detail
