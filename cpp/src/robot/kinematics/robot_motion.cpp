#include "mmgrasp/robot/robot_motion.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/robot/base_motion.hpp"

namespace mmgrasp {
namespace {

constexpr double kMaxStep =
    1e-6;  // Largest step between the end of a motion and the next one's begin [rad, m, rad/s, m/s].

void append_values(std::string& text, const double* values, Eigen::Index count) {
  for (Eigen::Index i = 0; i < count; ++i) {
    char digits[40];
    text += ',';
    text.append(digits, std::to_chars(digits, digits + sizeof(digits), values[i], std::chars_format::general, 17).ptr);
  }
}

template <typename V>
void require_joined(const V& end, const V& begin, const std::string& what) {
  if (end.size() == 0) return;
  const double jump = (begin - end).cwiseAbs().maxCoeff();
  require(jump <= kMaxStep, "next", jump, "must begin where the motion ends: " + what + " differ");
}

}  // namespace

void RobotMotion::wait(double duration) {
  require_not_negative(duration, "duration");
  if (times.empty()) throw InvalidInput("wait: the motion has no points");
  const double speed = std::max(velocities.back().size() ? velocities.back().cwiseAbs().maxCoeff() : 0.0,
                                base_twists.back().cwiseAbs().maxCoeff());
  require(speed <= kMaxStep, "wait: speed at the end", speed, "must be 0");
  if (duration == 0) return;
  times.push_back(times.back() + duration);
  positions.push_back(positions.back());
  base_poses.push_back(base_poses.back());
  velocities.push_back(Eigen::VectorXd::Zero(positions.back().size()));
  accelerations.push_back(velocities.back());
  base_twists.push_back(Eigen::Vector3d::Zero());
}

void RobotMotion::append(const RobotMotion& next) {
  if (next.times.empty()) throw InvalidInput("next: has no points");
  const double begin = duration();
  if (times.empty()) {
    *this = next;
    return;
  }
  if (joints != next.joints) throw InvalidInput("next: its joints are not those of the motion, in the same order");
  require_joined(positions.back(), next.positions.front(), "joint positions");
  require_joined(velocities.back(), next.velocities.front(), "joint velocities");
  // Headings mean the same after whole turns.
  const double apart = base_poses.back().z() - next.base_poses.front().z();
  const double turns = detail::kTwoPi * std::round(apart / detail::kTwoPi);
  const Eigen::Vector3d turned(0, 0, turns);
  require_joined(base_poses.back(), Eigen::Vector3d(next.base_poses.front() + turned), "base poses");
  require_joined(base_twists.back(), next.base_twists.front(), "base twists");
  accelerations.back() = next.accelerations.front();
  for (std::size_t i = 1; i < next.times.size(); ++i) {
    times.push_back(begin + next.times[i]);
    positions.push_back(next.positions[i]);
    velocities.push_back(next.velocities[i]);
    accelerations.push_back(next.accelerations[i]);
    base_poses.push_back(next.base_poses[i] + turned);
    base_twists.push_back(next.base_twists[i]);
  }
  for (GripperEvent event : next.gripper) {
    event.time += begin;
    gripper.push_back(event);
  }
}

std::string RobotMotion::to_csv() const {
  std::string text = "time,base.x,base.y,base.theta,base.v,base.vy,base.omega";
  for (const char* suffix : {"", ".velocity", ".acceleration"})
    for (const std::string& name : joints) text += "," + name + suffix;
  text += gripper.empty() ? "\n" : ",gripper\n";
  std::size_t next_event = 0;
  for (std::size_t i = 0; i < times.size(); ++i) {
    detail::throw_if_interrupted();
    std::string row;
    append_values(row, &times[i], 1);
    append_values(row, base_poses[i].data(), 3);
    append_values(row, base_twists[i].data(), 3);
    for (const auto* rows : {&positions, &velocities, &accelerations})
      append_values(row, (*rows)[i].data(), (*rows)[i].size());
    text.append(row, 1);
    if (!gripper.empty()) text += ',';
    for (bool first = true;
         next_event < gripper.size() && (gripper[next_event].time <= times[i] || i + 1 == times.size());
         ++next_event, first = false)
      text += std::string(first ? "" : " ") + (gripper[next_event].closes ? "close" : "open");
    text += '\n';
  }
  return text;
}

RobotMotion robot_motion(const JointTrajectory& trajectory, const std::optional<Eigen::Vector3d>& base_pose) {
  const std::size_t count = trajectory.times.size();
  const auto& names = trajectory.names;
  require(trajectory.velocities.size() == count && trajectory.accelerations.size() == count, "trajectory.velocities",
          static_cast<double>(trajectory.velocities.size()),
          "must be as many as times, and accelerations too: a path has to be timed to be carried out");
  const bool drives = names.size() >= 3 && names[0] == "x" && names[1] == "y" && names[2] == "theta";
  if (drives && base_pose)
    throw InvalidInput("base_pose: must be left out, the trajectory's columns x, y, theta move the base");
  const Eigen::Index first = drives ? 3 : 0, arm = static_cast<Eigen::Index>(names.size()) - first;
  RobotMotion motion;
  motion.joints.assign(names.begin() + first, names.end());
  motion.times = trajectory.times;
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::VectorXd &q = trajectory.positions[i], &v = trajectory.velocities[i];
    motion.positions.push_back(q.tail(arm));
    motion.velocities.push_back(v.tail(arm));
    motion.accelerations.push_back(trajectory.accelerations[i].tail(arm));
    motion.base_poses.push_back(drives ? Eigen::Vector3d(q.head<3>())
                                       : base_pose.value_or(Eigen::Vector3d(Eigen::Vector3d::Zero())));
    motion.base_twists.push_back(drives ? platform_velocity(q[2], v.head<3>())
                                        : Eigen::Vector3d(Eigen::Vector3d::Zero()));
  }
  return motion;
}

}  // namespace mmgrasp
