#pragma once

#include <vector>

#include "mmgrasp/task/base_pose_evaluator.hpp"
#include "mmgrasp/task/part_supply.hpp"
#include "task/part_supply/stop_robustness.hpp"
#include "task/problem/wording.hpp"

namespace mmgrasp::detail {

/// Explains why a tray's region is empty or too small for the uncertainty. A move that `earlier` obstructions advise
/// for this tray is repeated.
Obstruction explain_region(const PartSupplyProblem& problem, const ReachDatabase& database,
                           BasePoseEvaluator& evaluator, const BaseGrid& grid, TrayId tray, const BaseRegion& region,
                           const std::vector<Obstruction>& earlier = {});

/// Explains that too few of the base poses drawn at one of these stops serve all its parts.
Obstruction explain_robustness(const RobustnessResult& check, const std::vector<Stop>& stops);

/// Explains that no drive leads from the start, or a stop, to a base pose, or that the search for it gave up; `tray` is
/// the one to be served there, empty for the goal, `searched` what came of the search; with `smaller_clearance` [m]
/// there is one, unless it is negative.
Obstruction explain_route(const Eigen::Vector3d& from, bool from_stop, const Eigen::Vector3d& to,
                          const std::string& tray, const BasePath& searched, double smaller_clearance);

/// Explains that no drive leads from a base pose to the goal with a part in the hand; `searched`: what came of the last
/// search.
Obstruction explain_held_drive(const PartSupplyProblem& problem, const Eigen::Vector3d& base_pose, PartRef part,
                               const BasePath& searched);

/// Explains that no arm motion was found for this pick from a base pose; `remedies` as of pick_remedies().
Obstruction explain_motion(const PartSupplyProblem& problem, const Eigen::Vector3d& base_pose, const Pick& failed,
                           const std::vector<std::string>& remedies);

}  // namespace mmgrasp::detail
