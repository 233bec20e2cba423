#pragma once

#include <vector>

#include "mmgrasp/task/pick.hpp"

namespace mmgrasp::detail {

/// All picks at one stop, in the order in which they work: nearest part first; a part that its neighbours block comes
/// later.
struct StopPicks {
  Outcome outcome = Outcome::not_found;
  std::vector<Pick> picks;  ///< The picks in order; with no solution, those that failed.
};

/// `remaining` are the parts in place when the base arrives. Planned in parallel; the same answer at any thread count.
StopPicks plan_stop_picks(const PartSupplyProblem& problem, const ReachDatabase& database,
                          const Eigen::Vector3d& base_pose, const std::vector<TrayId>& trays,
                          const std::vector<PartRef>& remaining, const Monitor& monitor);

}  // namespace mmgrasp::detail
