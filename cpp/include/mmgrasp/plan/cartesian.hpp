#pragma once

#include <optional>
#include <string>
#include <vector>

#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/plan/straight_line.hpp"

namespace mmgrasp {

struct MMGRASP_EXPORT CartesianOptions {
  StraightLineOptions line;  ///< How each line is followed; a jump of the joints ends a branch.
  int max_branches = 64;     ///< Configurations of the first pose that are followed at most; > 0.
  void check() const;
};

struct MMGRASP_EXPORT CartesianResult {
  Outcome outcome = Outcome::infeasible;
  std::optional<JointPath> path;      ///< Begins at the first pose, ends at the last; set if and only if solved.
  std::vector<int> corners;           ///< Waypoint at which each pose is reached.
  double fraction = 0;                ///< How far the branch that came farthest got, in [0, 1]; lines count alike.
  Rejection cause = Rejection::none;  ///< Why that one ended there: reach (also: a jump), limits, ...
  std::optional<Contact> contact;     ///< What touches there, when something does.
  std::string beyond_limits;          ///< With invalid_start: what is wrong with `near`, as in MotionResult.
  int branches = 0;                   ///< Configurations of the first pose: those allowed.
  int tried = 0;                      ///< Of these: followed.
  Rejections rejections;              ///< Of the first pose's configurations.
};

/// The tool follows straight lines (rotation by slerp) from pose to pose, by dense inverse kinematics in which a jump
/// of the joints ends a try (plan_straight_line). Every inverse kinematics branch of the first pose is tried, seven
/// joints with their redundant one sampled; what comes back is the complete one with the shortest way: `near`, when it
/// is given, to the first waypoint and then along the path. A `near` that puts the tool at the first pose is itself the
/// first branch. The outcome is solved, infeasible, stopped, or invalid_start when the arm reaches the first pose, but
/// only beyond its limits or in collision. Throws InvalidInput on fewer than two poses, poses that are none, bad
/// options, and a group with a diff-drive base, which cannot follow such a path.
MMGRASP_EXPORT CartesianResult plan_cartesian(CollisionChecker& checker, const Poses& T_world_tip,
                                              const std::optional<Eigen::VectorXd>& near = std::nullopt,
                                              const CartesianOptions& options = {}, const Monitor& monitor = {});

}  // namespace mmgrasp
