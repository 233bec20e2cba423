#include "mmgrasp/robot/detail/least_motion.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/robot/detail/joint_group_data.hpp"

namespace mmgrasp::detail {
namespace {

double needed(double way, double rate) {
  if (!(way > 0)) return 0;
  return rate > 0 ? way / rate : kInfinity;
}

}  // namespace

double least_motion(const JointGroup& group, const Pose& T_world_from, const Pose& T_world_to, const IkOptions& ik,
                    const JointMetric& metric) {
  const double distance = (T_world_to.translation() - T_world_from.translation()).norm();
  const double angle = Eigen::AngleAxisd(T_world_from.linear().transpose() * T_world_to.linear()).angle();
  double speed = 0, turn = 0;  // along a path of length 1, squared
  for (const TipLever& lever : group.data().model->tip_levers) {
    double weight = metric.weight(lever.first);
    for (int i = 1; i < lever.count; ++i) weight = std::min(weight, metric.weight(lever.first + i));
    speed += std::pow(lever.speed / weight, 2);
    turn += std::pow(lever.turn / weight, 2);
  }
  return std::max(needed(distance - 2 * ik.position_tolerance, std::sqrt(speed)),
                  needed(angle - 2 * ik.rotation_tolerance, std::sqrt(turn)));
}

}  // namespace mmgrasp::detail
