#include "mmgrasp/robot/detail/group_record.hpp"

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/robot/detail/joint_group_data.hpp"

namespace mmgrasp::detail {

GroupRecord record_of(const JointGroup& group) {
  GroupRecord record{
      group.name(),        {}, group.tip_link(), group.has_base(), group.acceleration_limits(), group.reference(),
      group.T_world_root()};
  for (const int joint : group.joints())
    if (joint >= 0 && (record.joints.empty() || record.joints.back() != joint)) record.joints.push_back(joint);
  return record;
}

JointGroup group_of(const Robot& robot, const GroupRecord& record) {
  const auto is_there = [](int number, std::size_t count) { return number >= 0 && number < static_cast<int>(count); };
  bool whole = is_there(record.tip_link, robot.links().size());
  for (const int joint : record.joints) whole = whole && is_there(joint, robot.joints().size());
  if (!whole) throw InvalidInput("record of a group: names links or joints that the robot does not have");
  const JointGroup group =
      make_group(robot, record.name, record.joints, record.tip_link, record.has_base).with_reference(record.reference);
  const JointGroup limited = group.with_acceleration_limits(record.acceleration_limits);
  return record.has_base ? limited : limited.at(record.T_world_root);
}

}  // namespace mmgrasp::detail
