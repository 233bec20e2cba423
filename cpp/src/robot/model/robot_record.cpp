#include "mmgrasp/robot/detail/robot_record.hpp"

#include "robot/model/robot_data.hpp"

namespace mmgrasp::detail {

RobotRecord record_of(const Robot& robot) {
  const Robot::Data& data = robot.data();
  return {data, data.links, data.joints, data.disabled_pairs, data.default_values};
}

Robot robot_of(RobotRecord record) {
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
