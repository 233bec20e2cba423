#pragma once

#include <functional>
#include <string>
#include <vector>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/detail/stopwatch.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/plan/manipulation.hpp"
#include "plan/manipulation/common/grasp_candidates.hpp"
#include "plan/manipulation/common/transfer_checks.hpp"

namespace mmgrasp::detail {

/// What a planner of carries is given: everything but the way to search.
struct ManipulationInput {
  const ManipulationProblem& problem;
  const ManipulationOptions& options;
  const Roadmap* roadmap;  ///< The caller's; null when none was given.
  TransferChecks& checks;
  GraspCandidates& candidates;  ///< None found yet.
  const std::function<void(const Improvement&)>& improved;
  const Monitor& monitor;
  Stopwatch& clock;  ///< Of the whole call; a planner leaves out preparation that is not to count.

  bool out_of_time() const { return monitor.stopped() || clock.seconds() > options.time_limit; }
};

/// A path with one of the grasps.
struct TransferPath {
  int grasp = -1;
  double cost = kInfinity;  ///< Without a path: infinite.
  JointPath path;
};

/// Takes a path (checked already) when it is the cheapest so far: fills the result's path, grasp and cost, and tells
/// `improved`.
void take_path(const ManipulationInput& input, TransferPath carry, ManipulationResult& result);

/// One way to plan a carry. `run` sets the lower bound, and the path through take_path(); it returns whether all that
/// it can find was looked at, so that without a path there is none. When there is no candidate at all, what it sets and
/// returns does not matter.
struct ManipulationPlanner {
  const char* name;
  bool (*run)(ManipulationInput& input, ManipulationResult& result);
  double edge_steps;  ///< Along edges not yet part of a path, by those asked for.
};

/// Throws InvalidInput listing the known names.
const ManipulationPlanner& manipulation_planner(const std::string& name);

}  // namespace mmgrasp::detail
