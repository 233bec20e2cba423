#pragma once

#include <string>
#include <vector>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/detail/stopwatch.hpp"
#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/plan/improvement.hpp"
#include "mmgrasp/plan/manipulation.hpp"
#include "mmgrasp/robot/detail/joint_metric.hpp"
#include "plan/manipulation/common/grasp_candidates.hpp"
#include "plan/manipulation/common/transfer_checks.hpp"

namespace mmgrasp::detail {

/// Input of a planner over many grasps.
struct ManipulationInput {
  const ManipulationProblem& problem;
  const ManipulationOptions& options;
  const JointMetric& metric;  ///< Measures by the options' weights.
  const Roadmap* roadmap;     ///< The caller's; null when none was given.
  TransferChecks& checks;
  GraspCandidates& candidates;  ///< None found yet.
  const ImprovementCallback& on_improvement;
  const Monitor& monitor;
  Stopwatch& clock;  ///< Runs since the call began; a planner leaves out preparation that does not count.

  bool out_of_time() const { return monitor.stopped() || clock.seconds() > options.time_limit; }
};

/// How the planner's own roadmap is built.
inline RoadmapOptions roadmap_options(const ManipulationOptions& options) {
  RoadmapOptions own = options.prm.roadmap;
  own.joint_weights = options.joint_weights;
  return own;
}

/// A path with one of the grasps.
struct TransferPath {
  int grasp = -1;
  double cost = kInfinity;  ///< Infinite without a path.
  JointPath path;
  PlanStage stage = PlanStage::search;
};

/// Takes a path (checked already) when it is the cheapest so far: fills the result's path, grasp and cost, and calls
/// `on_improvement`.
void take_path(const ManipulationInput& input, TransferPath path, ManipulationResult& result);

/// A planner over many grasps. `run` sets the path by take_path(); it returns true when its search
/// came to its end before the budget did (over its own samples: no proof that there is no path). When there is no
/// candidate at all, what it sets and returns does not matter.
struct ManipulationPlanner {
  const char* name;
  bool (*run)(ManipulationInput& input, ManipulationResult& result);
};

/// Throws InvalidInput listing the known names.
const ManipulationPlanner& manipulation_planner(const std::string& name);

/// plan_manipulation() with this planner, whatever the options name.
MMGRASP_EXPORT ManipulationResult plan_manipulation_with(const ManipulationPlanner& planner,
                                                         const ManipulationProblem& problem,
                                                         const ManipulationOptions& options, const Roadmap* roadmap,
                                                         const Monitor& monitor,
                                                         const ImprovementCallback& on_improvement,
                                                         const CollisionChecker* checker);

}  // namespace mmgrasp::detail
