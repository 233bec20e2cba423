#pragma once

#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/core/outcome.hpp"
#include "mmgrasp/robot/trajectory.hpp"
#include "mmgrasp/task/problem.hpp"

namespace mmgrasp {

enum class MotionKind { reach, approach, lift, carry, retreat };
MMGRASP_EXPORT const char* to_string(MotionKind kind);

/// One timed arm motion at a stop.
struct MMGRASP_EXPORT PickMotion {
  MotionKind kind = MotionKind::reach;
  double opening = 0;    ///< Of the fingers during the motion [m].
  bool holding = false;  ///< The part is attached during the motion.
  JointTrajectory trajectory;
};

/// Home - reach the pre-grasp - approach straight - (close) - lift straight - carry to the bin - (open) - retreat to
/// home.
struct MMGRASP_EXPORT Pick {
  Outcome outcome = Outcome::infeasible;
  int stop = -1;
  int tray = -1, part = -1;         ///< Indices into the problem.
  int grasp = -1;                   ///< Index into the part's grasps.
  std::vector<PickMotion> motions;  ///< reach, approach, lift, carry, retreat.
  Rejections rejections;            ///< Grasps (and their configurations) turned down on the way.
  std::string failed_at;            ///< With no solution: the stage at which most candidates fell.
  double duration() const;
};

/// Plans one pick from a base pose. `remaining` are the parts still in place (tray, part); the picked one among them.
MMGRASP_EXPORT Pick plan_pick(const PartSupplyProblem& problem, const ReachDatabase& database,
                              const Eigen::Vector3d& base_pose, int tray, int part,
                              const std::vector<std::pair<int, int>>& remaining, const Monitor& monitor = {});

}  // namespace mmgrasp
