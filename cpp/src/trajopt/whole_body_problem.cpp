#include "mmgrasp/trajopt/whole_body_problem.hpp"

#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/robot/base_motion.hpp"
#include "trajopt/tool_chain.hpp"

namespace mmgrasp {
namespace {

using Eigen::VectorXd;

constexpr double kSlack = 1e-9;

std::string at(const std::string& field, Eigen::Index i) {
  return field + "[" + std::to_string(i) + "]";
}

void check_box(const VectorXd& lower, const VectorXd& upper, const std::string& field) {
  for (Eigen::Index i = 0; i < lower.size(); ++i) {
    require(lower[i] <= upper[i], at(field, i), "[" + std::to_string(lower[i]) + ", " + std::to_string(upper[i]) + "]",
            "the lower bound must not exceed the upper one");
  }
}

void check_within(const JointGroup& group, const VectorXd& lower, const VectorXd& upper, const std::string& field) {
  for (Eigen::Index i = 0; i < lower.size(); ++i) {
    require(lower[i] <= group.upper()[i] + kSlack && upper[i] >= group.lower()[i] - kSlack, at(field, i), lower[i],
            "must lie within the limits of " + group.names()[i]);
  }
}

void check_velocity(const JointGroup& group, const VectorXd& velocity, const std::string& field) {
  if (velocity.size() == 0) return;
  const VectorXd limits = drive_velocity_limits(group);
  require(velocity.size() == limits.size(), field, static_cast<double>(velocity.size()),
          "must have " + std::to_string(limits.size()) + " entries, as drive_names");
  for (Eigen::Index i = 0; i < limits.size(); ++i)
    require(std::abs(velocity[i]) <= limits[i] + kSlack, at(field, i), velocity[i], "must keep its limit");
}

void check_tool(const ToolConstraint& tool, int waypoints, const std::string& field) {
  require(tool.waypoint >= 0 && tool.waypoint < waypoints, field + ".waypoint", tool.waypoint,
          "must be in [0, " + std::to_string(waypoints) + ")");
  checked_pose(tool.T_world_tip.matrix(), field + ".T_world_tip");
  check_box(tool.lower, tool.upper, field + " bounds");
  check_box(tool.velocity_lower, tool.velocity_upper, field + " velocity bounds");
  require(tool.max_speed > 0, field + ".max_speed", tool.max_speed, "must be positive");
}

}  // namespace

BaseKind moving_base(const JointGroup& group) {
  return group.has_base() ? group.robot().base() : BaseKind::fixed;
}

std::vector<std::string> drive_names(const JointGroup& group) {
  std::vector<std::string> names = group.names();
  if (moving_base(group) != BaseKind::diff_drive) return names;
  names.erase(names.begin());
  names[0] = "v";
  names[1] = "omega";
  return names;
}

VectorXd drive_velocity_limits(const JointGroup& group) {
  const VectorXd& all = group.velocity_limits();
  if (moving_base(group) != BaseKind::diff_drive) return all;
  VectorXd limits = all.tail(all.size() - 1);
  const BaseLimits base = driving_limits(BaseKind::diff_drive, group.robot().base_limits());
  limits[0] = base.linear_velocity;
  limits[1] = base.angular_velocity;
  return limits;
}

VectorXd drive_acceleration_limits(const JointGroup& group) {
  const VectorXd& all = group.acceleration_limits();
  return moving_base(group) == BaseKind::diff_drive ? VectorXd(all.tail(all.size() - 1)) : all;
}

VectorXd configuration_velocity(const JointGroup& group, const VectorXd& q, const VectorXd& drive) {
  if (moving_base(group) != BaseKind::diff_drive) return drive;
  VectorXd velocity(q.size());
  velocity << drive[0] * std::cos(q[2]), drive[0] * std::sin(q[2]), drive.tail(drive.size() - 1);
  return velocity;
}

int WholeBodyProblem::intervals() const {
  int sum = 0;
  for (const WholeBodySegment& s : segments) sum += s.intervals;
  return sum;
}

int WholeBodyProblem::segment_end(int segment) const {
  int sum = 0;
  for (int i = 0; i <= segment; ++i) sum += segments[i].intervals;
  return sum;
}

void WholeBodyProblem::check() const {
  const detail::ToolChain supported(group);
  const Eigen::Index n = group.size();
  group.check_configuration(start, "start");
  check_within(group, start, start, "start");
  const std::string length = "must have " + std::to_string(n) + " entries";
  require(goal_lower.size() == n, "goal_lower", static_cast<double>(goal_lower.size()), length);
  require(goal_upper.size() == n, "goal_upper", static_cast<double>(goal_upper.size()), length);
  check_box(goal_lower, goal_upper, "goal");
  check_within(group, goal_lower, goal_upper, "goal");
  check_velocity(group, start_velocity, "start_velocity");
  check_velocity(group, end_velocity, "end_velocity");
  require(!segments.empty(), "segments", 0, "must hold at least one");
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const std::string field = "segments[" + std::to_string(i) + "]";
    require(segments[i].intervals > 0, field + ".intervals", segments[i].intervals, "must be positive");
    require_not_negative(segments[i].min_duration, field + ".min_duration");
    require(segments[i].max_duration > 0 && segments[i].max_duration >= segments[i].min_duration,
            field + ".max_duration", segments[i].max_duration, "must be positive and at least min_duration");
  }
  for (std::size_t i = 0; i < tool.size(); ++i) check_tool(tool[i], waypoints(), "tool[" + std::to_string(i) + "]");
  require_not_negative(jerk_time, "jerk_time");
  const VectorXd v = drive_velocity_limits(group), a = drive_acceleration_limits(group);
  const std::vector<std::string> names = drive_names(group);
  for (Eigen::Index i = 0; i < v.size(); ++i) {
    const std::string& name = names[i];
    require_positive(v[i], "velocity limit of " + name);
    require_positive(a[i], "acceleration limit of " + name);
  }
}

}  // namespace mmgrasp
