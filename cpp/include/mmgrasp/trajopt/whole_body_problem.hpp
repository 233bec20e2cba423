#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/robot/joint_group.hpp"

namespace mmgrasp {

/// What the tool has to keep at one waypoint (P1 4.4). Errors are taken in the frame of `T_world_tip`: translation [m],
/// then twice the vector part of the quaternion that turns the target into the tool, 2 sin(angle / 2) times the axis
/// [rad for small angles]: smooth everywhere and 0 for the target's rotation alone, also at 180 degrees from it.
struct MMGRASP_EXPORT ToolConstraint {
  int waypoint = 0;
  Pose T_world_tip = Pose::Identity();
  Vector6d lower = Vector6d::Zero();  ///< Bounds of the errors; equal: prescribed, infinite: free.
  Vector6d upper = Vector6d::Zero();
  double max_speed = std::numeric_limits<double>::infinity();  ///< Speed limit of the tip [m/s]; > 0.
  /// Bounds of the tip's velocity in the target's frame [m/s].
  Eigen::Vector3d velocity_lower = Eigen::Vector3d::Constant(-std::numeric_limits<double>::infinity());
  Eigen::Vector3d velocity_upper = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
};

/// Waypoints that share one time step (P1's Delta T_j), from one task to the next.
struct MMGRASP_EXPORT WholeBodySegment {
  int intervals = 17;       ///< > 0
  double min_duration = 0;  ///< Shortest duration [s], e.g. what a gripper needs to close; >= 0.
  double max_duration = std::numeric_limits<double>::infinity();  ///< Longest duration [s].
};

/// P1's problem (4.1)-(4.9): the fastest motion of base and arm through `tool` constraints, under the limits of the
/// group and of the robot's base.
///
///     WholeBodyProblem problem(robot.group("arm", "tool", true));
///     problem.start = start;
///     problem.goal_lower = problem.goal_upper = goal;
///     problem.segments = {{20, 0.0}, {20, 0.0}};  // intervals before and after the waypoint of the grasp
///     problem.tool = {grasp};
///     const WholeBodyResult result = optimize_whole_body(problem, guess);
///
/// - The variables are configuration and velocity at the waypoints; accelerations are constant between them, so that
///   joints follow (4.6) exactly.
/// - A diff-drive base is described by driving speed v and turning rate omega: it never slips sideways (4.5), and x and
///   y follow from integrating v and omega, linear between waypoints.
struct MMGRASP_EXPORT WholeBodyProblem {
  explicit WholeBodyProblem(JointGroup g) : group(std::move(g)) {}

  JointGroup group;
  Eigen::VectorXd start;                         ///< Configuration of the first waypoint.
  Eigen::VectorXd goal_lower, goal_upper;        ///< Box of the last one; equal: prescribed, infinite: free.
  Eigen::VectorXd start_velocity, end_velocity;  ///< Drive velocities (see drive_names); empty: at rest.
  std::vector<WholeBodySegment> segments;        ///< One more than there are tasks in the plain case.
  std::vector<ToolConstraint> tool;              ///< What the tool keeps at which waypoint.
  /// Shortest time in which an acceleration may go from 0 to its limit [s], >= 0; 0: no limit on jerk. From rest and
  /// to rest accelerations begin and end at 0.
  double jerk_time = 0;

  int intervals() const;
  int waypoints() const { return intervals() + 1; }
  bool starts_at_rest() const { return start_velocity.size() == 0 || start_velocity.isZero(); }
  bool ends_at_rest() const { return end_velocity.size() == 0 || end_velocity.isZero(); }
  /// Waypoint at the end of segment i.
  int segment_end(int segment) const;
  /// Throws InvalidInput naming what is contradictory: lengths, limits, tasks out of order, zero-length segments,
  /// start outside the limits, joints a chain cannot have here (planar, floating, mimicking).
  void check() const;
};

/// Velocities that a group is driven by: a diff-drive base "v" [m/s] and "omega" [rad/s], an omni-directional one the
/// velocities of x, y, theta in the world; then those of the joints.
MMGRASP_EXPORT std::vector<std::string> drive_names(const JointGroup& group);
MMGRASP_EXPORT Eigen::VectorXd drive_velocity_limits(const JointGroup& group);
MMGRASP_EXPORT Eigen::VectorXd drive_acceleration_limits(const JointGroup& group);
/// Velocity of the configuration for a drive velocity.
MMGRASP_EXPORT Eigen::VectorXd configuration_velocity(const JointGroup& group, const Eigen::VectorXd& q,
                                                      const Eigen::VectorXd& drive);
/// Kind of the base that moves with the group; fixed when the group has none.
MMGRASP_EXPORT BaseKind moving_base(const JointGroup& group);

}  // namespace mmgrasp
