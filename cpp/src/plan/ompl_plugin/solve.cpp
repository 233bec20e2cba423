// The plugin's entry point: one planning problem, solved by one of OMPL's planners.
#include <ompl/base/ProblemDefinition.h>
#include <ompl/base/goals/GoalStates.h>
#include <ompl/geometric/PathGeometric.h>
#include <ompl/util/Console.h>
#include <ompl/util/RandomNumbers.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <exception>
#include <mutex>
#include <shared_mutex>
#include <string>
#include <vector>

#include "mmgrasp/core/detail/numbers.hpp"
#include "plan/ompl_plugin/joint_space.hpp"
#include "plan/ompl_plugin/planners.hpp"
#include "plan/ompl_plugin/plugin_api.hpp"
#include "plan/ompl_plugin/run_context.hpp"

namespace mmgrasp_ompl {
namespace ob = ompl::base;
namespace og = ompl::geometric;
namespace {

const PlannerEntry* find_planner(const char* name) {
  for (std::size_t i = 0; i < kPlannerCount; ++i) {
    if (std::strcmp(kPlanners[i].name, name) == 0) return &kPlanners[i];
  }
  return nullptr;
}

/// Every run creates OMPL objects that draw seeds from the process-wide generator. Planners that depend on these seeds
/// hold it exclusively from seeding to the end; the others share.
std::shared_timed_mutex& seed_mutex() {
  static std::shared_timed_mutex mutex;
  return mutex;
}

/// The seed mutex for one run, which waits for it as long as its budget lasts.
class RunLock {
 public:
  RunLock(bool alone, const RunContext& context) : alone_(alone) {
    while (!held_ && !context.stopped()) {
      // Not try_lock_for, whose lock on the steady clock ThreadSanitizer does not see.
      const auto next_check = std::chrono::system_clock::now() + kBudgetCheckInterval;
      held_ = alone_ ? seed_mutex().try_lock_until(next_check) : seed_mutex().try_lock_shared_until(next_check);
    }
    // OMPL complains that seeds were drawn before (its log is off) and restarts its generator all the same; 0 it
    // ignores.
    const unsigned seed = context.problem().seed;
    if (held_ && alone_) ompl::RNG::setSeed(seed == 0 ? 0x9e3779b9u : seed);
  }
  ~RunLock() {
    if (held_) alone_ ? seed_mutex().unlock() : seed_mutex().unlock_shared();
  }
  RunLock(const RunLock&) = delete;
  RunLock& operator=(const RunLock&) = delete;

  bool held() const { return held_; }

 private:
  static constexpr std::chrono::milliseconds kBudgetCheckInterval{10};
  bool alone_, held_ = false;
};

void copy_in(const double* from, int size, ob::State* to) {
  std::memcpy(values(to), from, sizeof(double) * size);
}

ob::ProblemDefinitionPtr make_definition(const ob::SpaceInformationPtr& si, const MmgraspOmplProblem& problem,
                                         bool any_wraps) {
  auto definition = std::make_shared<ob::ProblemDefinition>(si);
  ob::State* state = si->allocState();
  copy_in(problem.start, problem.size, state);
  definition->addStartState(state);
  auto goals = std::make_shared<ob::GoalStates>(si);
  for (int g = 0; g < problem.goal_count; ++g) {
    copy_in(problem.goals + g * problem.size, problem.size, state);
    goals->addState(state);
  }
  si->freeState(state);
  definition->setGoal(goals);
  auto objective = std::make_shared<LengthObjective>(si, any_wraps);
  objective->setCostToGoHeuristic(&ob::goalRegionCostToGo);
  definition->setOptimizationObjective(objective);
  return definition;
}

/// Hands every better path to the caller: planners either call back with one or put it into the definition.
class Improvements {
 public:
  Improvements(const MmgraspOmplProblem& problem, const ob::SpaceInformationPtr& si,
               const ob::ProblemDefinitionPtr& definition)
      : problem_(problem), si_(si), definition_(definition) {}

  void add(std::vector<const ob::State*> states, double cost) {
    const ob::State* start = definition_->getStartState(0);
    if (states.empty() || !same(states.front(), start)) std::reverse(states.begin(), states.end());
    if (states.empty() || !same(states.front(), start)) states.insert(states.begin(), start);
    // Some leave the goal out as well; the cost shows which it is.
    const auto* goals = definition_->getGoal()->as<ob::GoalStates>();
    const ob::State* end = nullptr;
    double least = mmgrasp::detail::kInfinity;
    for (unsigned int g = 0; g < goals->getStateCount(); ++g) {
      if (same(states.back(), goals->getState(g))) return report(states);
      const double off = std::abs(length(states) + si_->distance(states.back(), goals->getState(g)) - cost);
      if (off < least) end = goals->getState(g);
      least = std::min(least, off);
    }
    if (least > 1e-6 * (1 + cost)) return;
    states.push_back(end);
    report(states);
  }

  void check_definition() {
    const ob::PathPtr path = definition_->hasExactSolution() ? definition_->getSolutionPath() : nullptr;
    if (!path || path == last_) return;
    last_ = path;
    const auto& states = path->as<og::PathGeometric>()->getStates();
    report({states.begin(), states.end()});
  }

 private:
  bool same(const ob::State* a, const ob::State* b) const { return si_->distance(a, b) < 1e-9; }

  double length(const std::vector<const ob::State*>& states) const {
    double sum = 0;
    for (std::size_t i = 1; i < states.size(); ++i) sum += si_->distance(states[i - 1], states[i]);
    return sum;
  }

  void report(const std::vector<const ob::State*>& states) {
    const double cost = length(states);
    if (cost > best_ - 1e-9) return;
    best_ = cost;
    std::vector<double> rows;
    for (const ob::State* state : states) rows.insert(rows.end(), values(state), values(state) + problem_.size);
    problem_.on_improvement(problem_.user, static_cast<int>(states.size()), rows.data());
  }

  const MmgraspOmplProblem& problem_;
  const ob::SpaceInformationPtr si_;
  const ob::ProblemDefinitionPtr definition_;
  ob::PathPtr last_;
  double best_ = mmgrasp::detail::kInfinity;
};

int run(const MmgraspOmplProblem& problem) {
  const PlannerEntry* entry = find_planner(problem.planner);
  if (!entry) {
    problem.fail(problem.user, "unknown planner");
    return MMGRASP_OMPL_FAILED;
  }
  const auto context = std::make_shared<RunContext>(problem, entry->count_rounds, entry->roadmap);
  const RunLock lock(entry->runs_alone, *context);
  if (!lock.held()) return MMGRASP_OMPL_BUDGET_SPENT;
  const auto space = std::make_shared<JointSpace>(context);
  const auto si = std::make_shared<ob::SpaceInformation>(space);
  si->setStateValidityChecker(std::make_shared<JointValidity>(si, context));
  si->setMotionValidator(std::make_shared<EdgeValidity>(si, context));
  si->setup();
  const ob::ProblemDefinitionPtr definition = make_definition(si, problem, space->any_wraps());
  const ob::PlannerPtr planner = entry->make(si);
  const double range = problem.range > 0 ? problem.range : entry->range_share * space->bounds_diagonal();
  if (range > 0 && planner->params().hasParam("range")) planner->params().setParam("range", std::to_string(range));
  planner->setProblemDefinition(definition);
  planner->setup();
  Improvements improvements(problem, si, definition);
  if (problem.on_improvement) {
    definition->setIntermediateSolutionCallback([&](const ob::Planner*, const std::vector<const ob::State*>& states,
                                                    const ob::Cost cost) { improvements.add(states, cost.value()); });
    context->watch([&] { improvements.check_definition(); });
  }
  if (entry->long_rounds) {
    const auto best_cost = planner->getPlannerProgressProperties().at("best cost REAL");
    context->throw_when_stopped([best_cost] { return std::isfinite(std::stod(best_cost())); });
  }
  // What setting up has drawn and checked is not the caller's budget.
  context->restart();
  try {
    planner->solve(ob::PlannerTerminationCondition([context] { return context->finished(); }));
  } catch (const RunStopped&) {
    context->watch({});
    planner->clear();
    return MMGRASP_OMPL_BUDGET_SPENT;
  }
  context->watch({});
  planner->clear();  // LazyPRM frees its states here and nowhere else

  if (!definition->hasExactSolution()) {
    return context->finished() ? MMGRASP_OMPL_BUDGET_SPENT : MMGRASP_OMPL_EXHAUSTED;
  }
  const auto* path = definition->getSolutionPath()->as<og::PathGeometric>();
  for (std::size_t i = 0; i < path->getStateCount(); ++i) problem.waypoint(problem.user, values(path->getState(i)));
  return MMGRASP_OMPL_SOLVED;
}

int solve(const MmgraspOmplProblem* problem) {
  try {
    return run(*problem);
  } catch (const std::exception& error) {
    problem->fail(problem->user, error.what());
  } catch (...) {
    problem->fail(problem->user, "unknown exception");
  }
  return MMGRASP_OMPL_FAILED;
}

const char* planner_name(int index) {
  return kPlanners[index].name;
}

int planner_keeps_improving(int index) {
  return kPlanners[index].keeps_improving ? 1 : 0;
}

}  // namespace
}  // namespace mmgrasp_ompl

const MmgraspOmplApi* mmgrasp_ompl_api() {
  static const MmgraspOmplApi api = [] {
    ompl::msg::setLogLevel(ompl::msg::LOG_NONE);
    ompl::msg::noOutputHandler();
    return MmgraspOmplApi{kMmgraspOmplApiVersion, static_cast<int>(mmgrasp_ompl::kPlannerCount),
                          mmgrasp_ompl::planner_name, mmgrasp_ompl::planner_keeps_improving, mmgrasp_ompl::solve};
  }();
  return &api;
}
