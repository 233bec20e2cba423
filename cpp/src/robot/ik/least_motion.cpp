#include "mmgrasp/robot/detail/least_motion.hpp"

#include <algorithm>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/robot/detail/joint_group_data.hpp"

namespace mmgrasp::detail {
namespace {

double needed(double way, double rate) {
  if (!(way > 0)) return 0;
  return rate > 0 ? way / rate : kInfinity;
}

}  // namespace

double least_motion(const JointGroup& group, const Pose& T_world_from, const Pose& T_world_to, const IkOptions& ik) {
  const GroupModel& model = *group.data().model;
  const double distance = (T_world_to.translation() - T_world_from.translation()).norm();
  const double angle = Eigen::AngleAxisd(T_world_from.linear().transpose() * T_world_to.linear()).angle();
  return std::max(needed(distance - 2 * ik.position_tolerance, model.tip_speed),
                  needed(angle - 2 * ik.rotation_tolerance, model.tip_turn));
}

}  // namespace mmgrasp::detail
