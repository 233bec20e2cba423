#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/plan/straight_line.hpp"

namespace mmgrasp {

/// Steps along the lines of a Cartesian path, and how many configurations of its first pose are tried.
struct MMGRASP_EXPORT CartesianOptions {
  StraightLineOptions line;  ///< Settings of each line; a jump of the joints ends a branch.
  int max_branches = 64;     ///< Configurations of the first pose tried at most; > 0.
  void check() const;
};

/// Joint path along all lines, or how far the best branch came and what ended it there.
struct MMGRASP_EXPORT CartesianResult {
  Outcome outcome = Outcome::not_found;
  std::optional<JointPath> path;  ///< Begins at the first pose, ends at the last; set if and only if solved.
  std::vector<int> corners;       ///< Waypoint at which each pose is reached.
  double fraction = 0;            ///< How far the branch that came farthest got, in [0, 1]; every line counts the same.
  Rejection cause = Rejection::none;  ///< Why that branch ended there: unreachable (also: a jump), limits, ...
  std::optional<Contact> contact;     ///< What touches there, when something does.
  std::string beyond_limits;          ///< With invalid_start: what is wrong with `near`, as in MotionResult.
  int branches = 0;                   ///< Allowed configurations of the first pose.
  int tried = 0;                      ///< How many of these were tried.
  Rejections rejections;              ///< Why configurations of the first pose were rejected.
};

/// A Cartesian path: the tool moves on straight lines (rotation by slerp) from pose to pose, each line by
/// plan_straight_line(), where a jump of the joints ends the try:
///
///     const CartesianResult result = plan_cartesian(checker, {T_world_above, T_world_grasp}, q_now);
///     if (result.path) drive(result.path->waypoints);
///
/// Every inverse kinematics branch of the first pose is tried, a redundant joint being sampled. Of the complete ones
/// the shortest is returned, counted from `near` when that is given. A `near` that puts the tool at the first pose is
/// itself the first branch. The outcome is solved, not_found, stopped, or invalid_start when the arm reaches the first
/// pose, but only beyond its limits or in collision. Throws InvalidInput on fewer than two poses, poses that are no
/// rigid transforms, bad options, and a group with a diff-drive base, which cannot follow such a path.
MMGRASP_EXPORT CartesianResult plan_cartesian(CollisionChecker& checker, const Poses& T_world_tip,
                                              const std::optional<Eigen::VectorXd>& near = std::nullopt,
                                              const CartesianOptions& options = {}, const Monitor& monitor = {});

}  // namespace mmgrasp
