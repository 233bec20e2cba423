#include "plan/ompl_plugin/repeatable_prm.hpp"

#include <ompl/base/OptimizationObjective.h>
#include <ompl/base/goals/GoalStates.h>
#include <ompl/geometric/PathGeometric.h>

namespace mmgrasp_ompl {
namespace ob = ompl::base;

ob::PlannerStatus RepeatablePrm::solve(const ob::PlannerTerminationCondition& ptc) {
  checkValidity();
  if (!isSetup()) setup();
  while (const ob::State* state = pis_.nextStart()) startM_.push_back(addMilestone(si_->cloneState(state)));
  while (const ob::State* state = pis_.nextGoal()) goalM_.push_back(addMilestone(si_->cloneState(state)));
  if (startM_.empty()) return ob::PlannerStatus::INVALID_START;
  if (goalM_.empty()) return ob::PlannerStatus::INVALID_GOAL;

  ob::PathPtr best;
  ob::Cost best_cost = opt_->infiniteCost();
  const auto search = [&] {
    for (const Vertex goal : goalM_) {
      if (!sameComponent(startM_.front(), goal)) continue;
      const ob::PathPtr path = constructSolution(startM_.front(), goal);
      if (!path || (best && !opt_->isCostBetterThan(path->cost(opt_), best_cost))) continue;
      best = path;
      best_cost = path->cost(opt_);
      if (!pdef_->getIntermediateSolutionCallback()) continue;
      const auto& states = path->as<ompl::geometric::PathGeometric>()->getStates();
      pdef_->getIntermediateSolutionCallback()(this, {states.begin(), states.end()}, best_cost);
    }
  };

  // Rounds are counted in milestones: two of growing to one of bouncing out of narrow places, as OMPL divides its time.
  const unsigned long milestones_per_round = 30;
  while (!ptc && !(best && !keep_improving_)) {
    const unsigned long grown = milestoneCount() + milestones_per_round;
    growRoadmap(ob::PlannerTerminationCondition([&] { return ptc || milestoneCount() >= grown; }));
    search();
    if (best && !keep_improving_) break;
    if (best) continue;
    const unsigned long expanded = milestoneCount() + milestones_per_round / 2;
    int rounds = 0;
    expandRoadmap(ob::PlannerTerminationCondition(
        [&] { return ptc || milestoneCount() >= expanded || ++rounds > static_cast<int>(milestones_per_round); }));
    search();
  }
  search();
  if (!best) return ob::PlannerStatus::TIMEOUT;
  pdef_->addSolutionPath(best, false, 0.0, getName());
  return ob::PlannerStatus::EXACT_SOLUTION;
}

}  // namespace mmgrasp_ompl
