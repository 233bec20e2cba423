// drive_by_motion(): the trajectory as a robot carries it out, with what the gripper does.
#include <algorithm>
#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/task/drive_by.hpp"

namespace mmgrasp {

RobotMotion drive_by_motion(const DriveByResult& result, const std::vector<double>& openings, double period) {
  require_within(period, 1e-4, 1e6, "period", "s");
  if (!result.trajectory) throw InvalidInput("result: there is no trajectory to carry out");
  const std::vector<double>& times = result.trajectory->times();
  double longest = 0;
  for (std::size_t i = 1; i < times.size(); ++i) longest = std::max(longest, times[i] - times[i - 1]);
  std::optional<Eigen::Vector3d> stands;
  if (const JointGroup& group = result.trajectory->group(); !group.has_base()) {
    const Pose& T = group.T_world_root();
    stands = Eigen::Vector3d(T.translation().x(), T.translation().y(), std::atan2(T(1, 0), T(0, 0)));
  }
  RobotMotion motion =
      robot_motion(result.trajectory->sampled(static_cast<int>(std::ceil(longest / period)) - 1), stands);
  for (const DriveByEvent& event : result.events) {
    if (event.object.empty()) continue;
    GripperEvent closing;
    closing.time = event.close_time;
    closing.duration = std::max(0.0, std::max(event.attach_time, event.time) - event.close_time);
    closing.object = event.object;
    if (motion.gripper.size() < openings.size()) closing.opening = openings[motion.gripper.size()];
    motion.gripper.push_back(closing);
  }
  require(openings.empty() || openings.size() == motion.gripper.size(), "openings",
          static_cast<double>(openings.size()), "must be as many as tasks that take an object");
  return motion;
}

}  // namespace mmgrasp
