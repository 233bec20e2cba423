#include "plan/manipulation/least_grasp_cost.hpp"

#include <algorithm>
#include <numeric>
#include <optional>
#include <string>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/detail/stopwatch.hpp"
#include "plan/manipulation/common/manipulation_planner.hpp"

namespace mmgrasp::detail {

/// The shortest path with any of the grasps is found first; while it is short enough, the search goes on with the
/// grasps that cost less than its grasp does. So a grasp is given up only when a cheaper one has a path, or when the
/// planner finds none short enough with it and all the cheaper ones together.
ManipulationResult plan_least_grasp_cost(const ManipulationProblem& problem, const ManipulationOptions& options,
                                         const Roadmap* roadmap, const Monitor& monitor,
                                         const ImprovementCallback& on_improvement, const CollisionChecker* checker) {
  problem.check();
  options.check();
  const Stopwatch clock;
  ManipulationOptions pass = options;
  ManipulationProblem left = problem;
  std::vector<int> index(problem.grasps.size());
  std::iota(index.begin(), index.end(), 0);
  double cheapest = kInfinity;
  for (Grasp& grasp : left.grasps) {
    cheapest = std::min(cheapest, grasp.cost);
    grasp.cost = 0;
  }
  ManipulationResult best;
  std::optional<Roadmap> built;
  for (bool first = true; !left.grasps.empty(); first = false) {
    if (!first && !roadmap && options.planner == "prm_star_mg") {
      built = Roadmap::build(problem.group, roadmap_options(options));
      roadmap = &*built;
    }
    ManipulationResult found =
        plan_manipulation_with(manipulation_planner(options.planner), left, pass, roadmap, monitor, {}, checker);
    const bool good = found.path && found.cost <= options.max_length;
    if (first) {
      best = found;
      best.improvements.clear();
      best.path.reset();
      best.cost = 0;
      best.grasp_index = -1;
      best.lower_bound += cheapest;  // of the length, whichever the grasp
      if (!good && found.path) {
        best.outcome = Outcome::not_found;
        best.warnings.push_back("the shortest path found is " + std::to_string(found.cost) + " long");
      }
    }
    if (!good) break;
    best.outcome = found.outcome;
    best.path = std::move(found.path);
    best.grasp_index = index[found.grasp_index];
    const double cost = problem.grasps[best.grasp_index].cost;
    best.cost = found.cost + cost;
    best.improvements.push_back(
        {clock.seconds(), best.cost, best.grasp_index, *best.path, found.improvements.back().stage});
    if (on_improvement) on_improvement(best.improvements.back());
    std::vector<int> cheaper;
    for (const int i : index) {
      if (problem.grasps[i].cost < cost) cheaper.push_back(i);
    }
    index = cheaper;
    left.grasps.clear();
    for (const int i : index) {
      left.grasps.push_back(problem.grasps[i]);
      left.grasps.back().cost = 0;
    }
    pass.time_limit = options.time_limit - clock.seconds();
    if (pass.time_limit <= 0 || monitor.stopped()) break;
  }
  return best;
}

}  // namespace mmgrasp::detail
