#pragma once

#include <vector>

#include "mmgrasp/task/pick.hpp"
#include "task/pick/part_pick.hpp"

namespace mmgrasp::detail {

/// plan_stop_picks() without its checks, each pick beginning at home as the problem has it; with drives to the goal.
StopPicks stop_picks(const PartSupplyProblem& problem, const ReachDatabase& database, const Eigen::Vector3d& base_pose,
                     const std::vector<TrayId>& trays, const std::vector<PartRef>& remaining, const Monitor& monitor,
                     const HeldDrive& drive = {});

}  // namespace mmgrasp::detail
