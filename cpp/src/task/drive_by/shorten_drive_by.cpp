// shorten_drive_by(): a motion that is known instead of guesses.
#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/monitor_part.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/detail/stopwatch.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/task/drive_by.hpp"
#include "task/drive_by/drive_by_events.hpp"
#include "task/drive_by/drive_by_seed.hpp"

namespace mmgrasp {
namespace {

using Eigen::VectorXd;

VectorXd at(const KnownMotion& known, double time) {
  const auto after = std::upper_bound(known.times.begin(), known.times.end(), time);
  if (after == known.times.begin()) return known.positions.front();
  if (after == known.times.end()) return known.positions.back();
  const std::size_t i = after - known.times.begin();
  const double share = (time - known.times[i - 1]) / (known.times[i] - known.times[i - 1]);
  return known.positions[i - 1] + share * (known.positions[i] - known.positions[i - 1]);
}

void check_known(const JointGroup& group, const std::vector<DriveByTask>& tasks, const KnownMotion& known) {
  require(known.times.size() >= 2, "times", static_cast<double>(known.times.size()), "must hold at least two");
  require(known.positions.size() == known.times.size(), "positions", static_cast<double>(known.positions.size()),
          "must be as many as times");
  for (const VectorXd& q : known.positions) {
    require(q.size() == group.size(), "positions", static_cast<double>(q.size()),
            "must hold " + std::to_string(group.size()) + " values each");
    require_numbers(q, "positions", "rad or m");
  }
  for (std::size_t i = 0; i < known.times.size(); ++i) {
    const double before = i == 0 ? -detail::kInfinity : known.times[i - 1];
    require_number(known.times[i], "times");
    require(known.times[i] > before, "times", known.times[i], "must be finite and increase");
  }
  require(known.task_times.size() == tasks.size(), "task_times", static_cast<double>(known.task_times.size()),
          "must be as many as tasks");
  double free_from = known.times.front();
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    const std::string field = "tasks[" + std::to_string(i) + "]";
    require(tasks[i].candidates.size() == 1, field + ".candidates", static_cast<double>(tasks[i].candidates.size()),
            "must hold one pose");
    require(!tasks[i].push, field + ".push", 1, "must be left out");
    require(known.task_times[i] > free_from, "task_times", known.task_times[i],
            "must lie inside the motion, in order, after the dwell before");
    free_from = known.task_times[i] + tasks[i].dwell;
  }
  require(free_from < known.times.back(), "task_times", free_from, "must end before the motion does");
}

/// The known motion at the waypoints of the problem.
WholeBodyGuess guess_along(const KnownMotion& known, const std::vector<DriveByTask>& tasks,
                           const std::vector<int>& intervals) {
  std::vector<double> ends;
  for (std::size_t t = 0; t < tasks.size(); ++t) {
    ends.push_back(known.task_times[t]);
    if (tasks[t].dwell > 0) ends.push_back(known.task_times[t] + tasks[t].dwell);
  }
  ends.push_back(known.times.back());
  WholeBodyGuess guess;
  guess.collision_free = true;
  double from = known.times.front();
  for (std::size_t s = 0; s < intervals.size(); ++s) {
    const double step = (ends[s] - from) / intervals[s];
    for (int i = 0; i < intervals[s]; ++i) guess.positions.push_back(at(known, from + i * step));
    guess.steps.push_back(step);
    from = ends[s];
  }
  guess.positions.push_back(known.positions.back());
  return guess;
}

}  // namespace

DriveByResult shorten_drive_by(const JointGroup& group, const World& world, const std::vector<DriveByTask>& tasks,
                               const KnownMotion& known, const DriveByOptions& options, const Monitor& monitor) {
  options.check();
  detail::check_tasks(tasks, world);
  check_known(group, tasks, known);
  const std::vector<detail::DriveByStep> steps = detail::steps_of(tasks);
  const int least = 2 + 2 * static_cast<int>(steps.size());
  require(options.waypoints >= least, "waypoints", options.waypoints, "must be at least " + std::to_string(least));
  const VectorXd& start = known.positions.front();
  const DriveByGoal goal{known.positions.back(), known.positions.back()};
  std::optional<detail::SceneStates> scene_states;
  if (options.collisions) scene_states.emplace(group, world, steps);
  detail::DriveBySeeds seeds(group, start, steps, goal, options, scene_states ? &*scene_states : nullptr);
  const detail::Stopwatch stopwatch;
  detail::ConfigurationSequence sequence;
  for (const double time : known.task_times) sequence.push_back({at(known, time), 0});
  detail::SeededProblem a = seeds.make(sequence, options.waypoints);
  a.problem.check();
  a.guess = guess_along(known, tasks, a.intervals);
  const Monitor part = detail::monitor_part(monitor, "shortening", 0, 1);
  part.report("", 0);
  DriveByResult result;
  result.grasp_assignments = 1;
  WholeBodyResult r;
  // Separating bodies as they lie in the known motion keeps that motion feasible, but holds the new one back where it
  // is elsewhere at the same waypoint.
  for (const bool keeps_sides : {false, true}) {
    a.guess.keeps_sides = keeps_sides;
    r = optimize_whole_body(a.problem, a.guess, options.trajectory, a.checkers, part);
    ++result.solves;
    result.iterations += r.iterations;
    result.report += "from a known motion: " + detail::describe(r) +
                     (r.usable() ? ", " + detail::number(r.trajectory->duration()) + " s" : "") + "\n";
    if (r.usable() || a.checkers.empty() || monitor.stopped()) break;
  }
  result.outcome = monitor.stopped() && !r.usable() ? Outcome::stopped : r.outcome;
  result.trajectory = r.trajectory;
  result.violations = r.violations;
  result.events = detail::events_of(*r.trajectory, world, steps, a.waypoints, sequence);
  result.seconds = stopwatch.seconds();
  return result;
}

}  // namespace mmgrasp
