#pragma once

#include <cstdint>
#include <functional>
#include <utility>

#include "mmgrasp/core/detail/stopwatch.hpp"
#include "plan/ompl_plugin/plugin_api.hpp"

namespace mmgrasp_ompl {

/// Thrown out of a planner whose rounds take any time: when the caller's cancel token is set, for nobody wants its path
/// then, or when the time limit has passed and it has no path to lose.
struct RunStopped {};

/// What one run has spent of its budget, shared by sampler, validity checker and termination condition.
class RunContext {
 public:
  RunContext(const MmgraspOmplProblem& problem, bool count_rounds, bool roadmap)
      : problem_(problem), count_rounds_(count_rounds), roadmap_(roadmap), time_limit_(problem.time_limit) {}

  const MmgraspOmplProblem& problem() const { return problem_; }

  /// Ends are joined through vertices drawn near them alone; trees grow from them.
  bool roadmap() const { return roadmap_; }

  /// `check` is called at every check of the budget.
  void watch(std::function<void()> check) { on_budget_check_ = std::move(check); }
  /// Watches planners whose rounds may take seconds without a check of the budget. `has_path`: whether they have one.
  void throw_when_stopped(std::function<bool()> has_path) { has_path_ = std::move(has_path); }
  void restart() { draws_ = checks_ = rounds_ = 0; }
  void count_draw() { ++draws_; }
  /// Different for each sampler of a run, the same in every run.
  std::uint64_t next_sampler_seed() { return (static_cast<std::uint64_t>(problem_.seed) << 16) + samplers_++; }

  bool is_free(const double* q) {
    ++checks_;
    return !stopped() && problem_.is_free(problem_.user, q) != 0;
  }
  /// A stopped run refuses every edge, so that even a planner deep inside one iteration ends soon. Throws RunStopped.
  bool edge_is_free(const double* q0, const double* q1) {
    if (has_path_ && stopped() && (problem_.stopped(problem_.user) != 0 || !has_path_())) throw RunStopped{};
    return !stopped() && problem_.edge_is_free(problem_.user, q0, q1) != 0;
  }

  /// Whether the caller or the time limit ended the run.
  bool stopped() const { return problem_.stopped(problem_.user) != 0 || time_limit_.expired(); }

  /// The termination condition: called by planners once per round or more often.
  bool finished() {
    ++rounds_;
    if (on_budget_check_) on_budget_check_();
    const long budget = problem_.max_iterations;
    return draws_ >= budget || checks_ >= budget || (count_rounds_ && rounds_ > budget) || stopped();
  }

 private:
  const MmgraspOmplProblem& problem_;
  bool count_rounds_, roadmap_;
  mmgrasp::detail::TimeLimit time_limit_;
  long draws_ = 0, checks_ = 0, rounds_ = 0;
  std::uint64_t samplers_ = 0;
  std::function<void()> on_budget_check_;
  std::function<bool()> has_path_;
};

}  // namespace mmgrasp_ompl
