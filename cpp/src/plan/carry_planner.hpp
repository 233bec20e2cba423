#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/plan/manipulation.hpp"
#include "plan/carry_candidates.hpp"
#include "plan/carry_checks.hpp"

namespace mmgrasp::detail {

/// Wall-clock time since it was made or started again.
class CarryClock {
 public:
  void start() { begin_ = std::chrono::steady_clock::now(); }
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count(); }

 private:
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

/// What a planner of carries is given: everything but the way to search.
struct CarryInput {
  const ManipulationProblem& problem;
  const ManipulationOptions& options;
  const Roadmap* roadmap;  ///< The caller's; null when none was given.
  CarryChecks& checks;
  std::vector<CarryCandidate> candidates;  ///< At least one.
  double time_limit;                       ///< Left for the search [s].
  const std::function<void(const Improvement&)>& improved;
  const Monitor& monitor;
  CarryClock clock{};  ///< Of the search; a planner starts it again when its preparation is not to count.

  bool out_of_time() const { return monitor.stopped() || clock.seconds() > time_limit; }
};

/// Takes a path (checked already) as the best so far: fills the result's path, grasp and cost, and tells `improved`.
void take_path(const CarryInput& input, int grasp, double cost, JointPath path, ManipulationResult& result);

/// One way to plan a carry. `run` sets outcome and lower bound, and the path through take_path().
struct CarryPlanner {
  const char* name;
  void (*run)(CarryInput& input, ManipulationResult& result);
};

/// Throws InvalidInput listing the known names.
const CarryPlanner& carry_planner(const std::string& name);

}  // namespace mmgrasp::detail
