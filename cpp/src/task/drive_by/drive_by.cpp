#include "mmgrasp/task/drive_by.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "mmgrasp/core/detail/monitor_part.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/core/parallel.hpp"
#include "task/drive_by/drive_by_assignments.hpp"
#include "task/drive_by/drive_by_events.hpp"
#include "task/drive_by/drive_by_solve.hpp"

namespace mmgrasp {
namespace {

using detail::ConfigurationSequence;
using detail::DriveByStep;
using detail::GoalConfigurations;
using detail::GraspAssignment;
using detail::SolveSettings;
using detail::StepConfiguration;
using Eigen::VectorXd;

constexpr int kShortBudget = 80;       // iterations of a solve in the first round
constexpr std::size_t kMoreSeeds = 2;  // sequences tried of each assignment once there is a motion to beat

/// What blocks most of the configurations that reach a task: "; in 12 of 30 that do 'hand' touches 'table'".
std::string most_frequent_contact(CollisionChecker& checker, const GoalConfigurations& in_reach) {
  std::map<std::string, std::size_t> count;
  for (const StepConfiguration& configuration : in_reach)
    for (const Contact& contact : checker.contacts(configuration.q)) ++count[describe(contact)];
  if (count.empty()) return {};
  const auto most =
      std::max_element(count.begin(), count.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return "; in " + std::to_string(most->second) + " of " + std::to_string(in_reach.size()) + " that do " + most->first;
}

/// One plan: keeps what all seeds share.
class DriveBy {
 public:
  DriveBy(const JointGroup& group, const World& world, const VectorXd& start, const std::vector<DriveByTask>& tasks,
          const DriveByGoal& goal, const DriveByOptions& options, const Monitor& monitor,
          const CollisionChecker* prepared = nullptr)
      : group_(group),
        world_(world),
        start_(start),
        steps_(detail::steps_of(tasks)),
        goal_(goal),
        options_(options),
        monitor_(monitor),
        part_{monitor.stop, {}} {
    for (int i = 0; i < group.size(); ++i) {
      if (!group.wraps()[i]) continue;
      if (goal_.lower[i] != goal_.upper[i]) continue;
      goal_.lower[i] = goal_.upper[i] = start[i] + wrap_angle(goal_.lower[i] - start[i]);
    }
    if (options.collisions) scene_states_.emplace(group_, world, steps_, prepared);
    solver_.emplace(group_, start_, steps_, goal_, options_, scene_states_ ? &*scene_states_ : nullptr, part_);
  }

  DriveByResult run() {
    DriveByResult result;
    if (const auto touching = scene_states_ ? scene_states_->before(0).first_contact(start_) : std::nullopt) {
      result.outcome = Outcome::invalid_start;
      result.report = "start: " + describe(*touching);
      return result;
    }
    std::string missing;
    const std::vector<GraspAssignment> assignments = find_assignments(missing);
    if (assignments.empty()) {
      result.outcome = monitor_.stopped() ? Outcome::stopped : Outcome::not_found;
      result.report = missing;
      return result;
    }
    for (const GraspAssignment& assignment : assignments) {
      if (result.grasp_assignments > 0 && over(result)) break;
      if (result.usable() && assignment.bound >= result.duration()) {
        result.report +=
            "candidates " + name(assignment) + ": left out, not below " + detail::number(assignment.bound) + " s\n";
        continue;
      }
      const double share = 1.0 / static_cast<double>(assignments.size()), done = result.grasp_assignments * share;
      part_ = detail::monitor_part(monitor_, "grasp_assignments", done, done + share);
      part_.report("", 0);
      solve_all(assignment, result);
      if (++result.grasp_assignments == options_.grasp_assignments) break;
    }
    if (!result.usable()) {
      if (monitor_.stopped())
        result.outcome = Outcome::stopped;
      else if (over(result))
        result.outcome = Outcome::timeout;
    }
    return result;
  }

  std::optional<DriveByStart> first_guess() {
    std::string missing;
    const std::vector<GraspAssignment> assignments = find_assignments(missing);
    if (assignments.empty()) return {};
    detail::SeededProblem a = solver_->seeds().make(assignments.front().sequences.front(), options_.waypoints);
    return DriveByStart{std::move(a.problem), std::move(a.guess)};
  }

  double seconds() const { return solver_->seconds(); }

 private:
  bool over(const DriveByResult& result) const {
    return monitor_.stopped() || result.iterations >= options_.iterations || seconds() > options_.time_limit;
  }

  std::vector<GraspAssignment> find_assignments(std::string& missing) {
    const VectorXd goal = detail::goal_near(goal_, start_);
    std::vector<GoalConfigurations> goals;
    for (std::size_t i = 0; i < steps_.size(); ++i) {
      const VectorXd before = rough_configuration(static_cast<int>(i) - 1, goal),
                     after = rough_configuration(static_cast<int>(i) + 1, goal);
      CollisionChecker* checker = scene_states_ ? &scene_states_->before(i) : nullptr;
      const auto configurations = [&](CollisionChecker* checker) {
        return steps_[i].way > 0
                   ? detail::follow_goal_configurations(group_, checker, steps_[i], goals.at(i - 1), monitor_)
                   : detail::find_goal_configurations(group_, checker, steps_[i], before, after, options_,
                                                      static_cast<unsigned>(i), monitor_);
      };
      goals.push_back(configurations(checker));
      if (!goals.back().empty()) continue;
      missing = "task " + std::to_string(steps_[i].task) + ": no configuration within the limits" +
                (scene_states_ ? " and free of collisions" : "") + " brings the tool there (" +
                std::to_string(options_.goal_configurations) + " tries at a time)";
      if (!checker) return {};
      const GoalConfigurations in_reach = configurations(nullptr);
      missing += most_frequent_contact(*checker, in_reach);
      return {};
    }
    const auto collisions = [&](const ConfigurationSequence& sequence) { return solver_->collisions(sequence); };
    return detail::drive_by_assignments(group_, steps_, goals, start_, goal_, options_, collisions);
  }

  /// Roughly where the robot is at a step, before anything is known: the base below the tool.
  VectorXd rough_configuration(int step, const VectorXd& goal) const {
    if (step < 0) return start_;
    if (step >= static_cast<int>(steps_.size())) return goal;
    VectorXd q = 0.5 * (start_ + goal);
    if (group_.has_base()) q.head<2>() = steps_[step].candidates[0].translation().head<2>();
    return q;
  }

  static std::string name(const GraspAssignment& assignment) {
    std::string text;
    for (const StepConfiguration& configuration : assignment.sequences.front())
      text += (text.empty() ? "" : ", ") + std::to_string(configuration.candidate);
    return "[" + text + "]";
  }

  /// Every sequence with a short iteration budget first: what can be solved mostly is within few iterations. Ways
  /// around obstacles are along the reference path and sampled by turns, the second time the other way round.
  void solve_all(const GraspAssignment& assignment, DriveByResult& result) {
    int solutions = 0;
    const std::size_t most =
        std::min(result.usable() ? kMoreSeeds : assignment.sequences.size(), assignment.sequences.size());
    const int budget = options_.trajectory.max_iterations;
    const std::size_t rounds = budget > kShortBudget && !result.usable() ? 2 : 1;
    for (std::size_t round = 0; round < rounds && solutions == 0; ++round) {
      for (std::size_t i = 0; i < most && !over(result); ++i) {
        const SolveSettings settings{round == 0 ? std::min(kShortBudget, budget) : budget, round > 0,
                                     (i + round) % 2 == 0};
        if (solve_sequence(assignment, i, settings, result) && ++solutions >= options_.solutions) return;
      }
    }
  }

  bool solve_sequence(const GraspAssignment& assignment, std::size_t index, const SolveSettings& settings,
                      DriveByResult& result) {
    const ConfigurationSequence& sequence = assignment.sequences[index];
    std::vector<int> waypoints;
    const WholeBodyResult r = solver_->solve(sequence, settings, waypoints);
    ++result.solves;
    result.iterations += r.iterations;
    result.report += "solve " + std::to_string(result.solves) + ", candidates " + name(assignment) + ": " +
                     detail::describe(r) + (r.usable() ? ", " + detail::number(r.trajectory->duration()) + " s" : "") +
                     "\n";
    const bool better = r.usable() ? !result.usable() || r.trajectory->duration() < result.duration()
                                   : !result.usable() && detail::broken(r) < least_broken_;
    if (better) {
      if (!r.usable()) least_broken_ = detail::broken(r);
      result.outcome = r.outcome;
      result.trajectory = r.trajectory;
      result.violations = r.violations;
      result.events = detail::events_of(*r.trajectory, world_, steps_, waypoints, sequence);
    }
    return r.usable();
  }

  const JointGroup& group_;
  const World& world_;
  VectorXd start_;
  std::vector<DriveByStep> steps_;
  DriveByGoal goal_;
  const DriveByOptions& options_;
  const Monitor& monitor_;
  Monitor part_;  // Heard by the solver: that of the candidates it works on.
  std::optional<detail::SceneStates> scene_states_;
  std::optional<detail::DriveBySolver> solver_;
  double least_broken_ = detail::kInfinity;
};

}  // namespace

void DriveByOptions::check() const {
  require_within(waypoints, 2, 1000, "waypoints", "");
  require_count(seeds, "seeds", 1, 1'000'000);
  require_count(solutions, "solutions", 1, 1'000'000);
  require_count(grasp_assignments, "grasp_assignments", 1, 1'000'000);
  require_within(goal_configurations, 1, 1e4, "goal_configurations", "");
  require_count(iterations, "iterations");
  require(time_limit > 0, "time_limit", time_limit, "must be positive");
  require_not_negative(jerk_time, "jerk_time");
  resolve_threads(threads);  // says what is wrong
  trajectory.check();
}

namespace {

void check_call(const JointGroup& group, const World& world, const VectorXd& start,
                const std::vector<DriveByTask>& tasks, const DriveByGoal& goal, const DriveByOptions& options) {
  options.check();
  detail::check_tasks(tasks, world);
  const int least = 2 + 2 * static_cast<int>(detail::steps_of(tasks).size());
  require(options.waypoints >= least, "waypoints", options.waypoints,
          "must be at least " + std::to_string(least) + " for " + std::to_string(tasks.size()) + " tasks");
  WholeBodyProblem ends(group);
  ends.start = start;
  ends.goal_lower = goal.lower;
  ends.goal_upper = goal.upper;
  ends.segments = {{1}};
  ends.check();
}

DriveByResult planned(DriveBy&& plan) {
  DriveByResult result = plan.run();
  result.seconds = plan.seconds();
  return result;
}

}  // namespace

DriveByResult plan_drive_by(const JointGroup& group, const World& world, const VectorXd& start,
                            const std::vector<DriveByTask>& tasks, const DriveByGoal& goal,
                            const DriveByOptions& options, const Monitor& monitor) {
  check_call(group, world, start, tasks, goal, options);
  return planned(DriveBy(group, world, start, tasks, goal, options, monitor));
}

DriveByResult plan_drive_by(const CollisionChecker& checker, const VectorXd& start,
                            const std::vector<DriveByTask>& tasks, const DriveByGoal& goal,
                            const DriveByOptions& options, const Monitor& monitor) {
  require(!checker.options().attached_only, "checker: attached_only", "true", "must check the robot itself, too");
  check_call(checker.group(), checker.world(), start, tasks, goal, options);
  return planned(DriveBy(checker.group(), checker.world(), start, tasks, goal, options, monitor, &checker));
}

std::optional<DriveByStart> first_drive_by_guess(const JointGroup& group, const VectorXd& start,
                                                 const std::vector<DriveByTask>& tasks, const DriveByGoal& goal,
                                                 const DriveByOptions& options) {
  const World nothing;
  const Monitor silent;
  DriveByOptions blind = options;
  blind.collisions = false;
  check_call(group, nothing, start, tasks, goal, blind);
  return DriveBy(group, nothing, start, tasks, goal, blind, silent).first_guess();
}

std::optional<WholeBodyProgram> drive_by_program(const JointGroup& group, const VectorXd& start,
                                                 const std::vector<DriveByTask>& tasks, const DriveByGoal& goal,
                                                 const DriveByOptions& options) {
  const std::optional<DriveByStart> first = first_drive_by_guess(group, start, tasks, goal, options);
  if (!first) return {};
  return WholeBodyProgram(first->problem, first->guess, options.trajectory.smoothing);
}

}  // namespace mmgrasp
