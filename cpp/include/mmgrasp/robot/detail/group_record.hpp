#pragma once

#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/robot/joint_group.hpp"

namespace mmgrasp::detail {

/// A group as plain data, of a robot that is known.
struct GroupRecord {
  std::string name;
  std::vector<int> joints;  ///< Robot joints in the order of the columns, each once.
  int tip_link = 0;
  bool has_base = false;
  Eigen::VectorXd acceleration_limits, reference;
  Pose T_world_root = Pose::Identity();
};

MMGRASP_EXPORT GroupRecord record_of(const JointGroup& group);
MMGRASP_EXPORT JointGroup group_of(const Robot& robot, const GroupRecord& record);

}  // namespace mmgrasp::detail
