#include "task/drive_by/drive_by_solve.hpp"

#include <algorithm>

#include "task/drive_by/drive_by_route.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::VectorXd;

constexpr int kCoarse = 35;       // waypoints of a first solution
constexpr int kMany = 150;        // when more than these are required
constexpr double kRefine = 1e-3;  // barrier with which it is refined

}  // namespace

double broken(const WholeBodyResult& r) {
  double sum = 0;
  for (const Violation& v : r.violations)
    if (!v.kept()) sum += 1 + v.value;
  return sum;
}

DriveBySolver::DriveBySolver(const JointGroup& group, const VectorXd& start, const std::vector<DriveByStep>& steps,
                             const DriveByGoal& goal, const DriveByOptions& options, SceneStates* scene_states,
                             const Monitor& monitor)
    : group_(group),
      start_(start),
      steps_(steps),
      goal_(goal),
      options_(options),
      scene_states_(scene_states),
      seeds_(group, start, steps, goal, options, scene_states),
      monitor_(monitor) {}

int DriveBySolver::collisions(const ConfigurationSequence& sequence) {
  if (!scene_states_) return 0;
  const SeededProblem a = seeds_.make(sequence, options_.waypoints, false);
  int count = 0;
  std::size_t step = 0;
  for (int i = 1; i < a.problem.intervals(); ++i) {
    while (step < a.waypoints.size() && i > a.waypoints[step]) ++step;
    count += !scene_states_->before(step).is_free(a.guess.positions[i]);
  }
  return count;
}

WholeBodyResult DriveBySolver::solve(const ConfigurationSequence& sequence, const SolveSettings& settings,
                                     std::vector<int>& waypoints) {
  iterations_ = settings.iteration_budget;
  const int few = std::max(kCoarse, 2 + 4 * static_cast<int>(steps_.size()));
  SeededProblem a =
      seeds_.make(sequence, std::min(options_.waypoints, options_.waypoints > kMany ? few : options_.waypoints));
  lead_around_obstacles(a, sequence, settings);
  WholeBodyResult r = optimize(a);
  if (r.usable() && a.problem.waypoints() < options_.waypoints) {
    SeededProblem fine = seeds_.make(sequence, options_.waypoints);
    fine.problem.goal_lower = a.problem.goal_lower;
    fine.problem.goal_upper = a.problem.goal_upper;
    std::vector<double> ends;
    for (int s = 0; s < static_cast<int>(a.intervals.size()); ++s)
      ends.push_back(r.trajectory->times()[a.problem.segment_end(s)]);
    fine.guess = resampled(*r.trajectory, ends, fine.intervals);
    fine.guess.collision_free = !fine.checkers.empty();
    const int before = r.iterations;
    r = optimize(fine, kRefine);
    r.iterations += before;
    a = std::move(fine);
  }
  waypoints = a.waypoints;
  return r;
}

void DriveBySolver::lead_around_obstacles(SeededProblem& a, const ConfigurationSequence& sequence,
                                          const SolveSettings& settings) {
  if (!scene_states_ || (!settings.guided && collisions(sequence) == 0)) return;
  const std::optional<DriveByRoute> way = route(sequence, a, settings.by_reference_path);
  if (way) a = seeds_.make(sequence, a.problem.waypoints(), true, &*way);
}

WholeBodyResult DriveBySolver::optimize(const SeededProblem& a, double warm_start) {
  WholeBodyOptions options = options_.trajectory;
  options.warm_start = std::max(options.warm_start, warm_start);
  options.max_iterations = std::min(options.max_iterations, iterations_);
  options.time_limit = std::max(1e-3, std::min(options.time_limit, options_.time_limit - seconds()));
  return optimize_whole_body(a.problem, a.guess, options, a.checkers, monitor_);
}

CollisionChecker& DriveBySolver::checker_between(const SeededProblem& a, std::size_t step, const VectorXd& from,
                                                 const VectorXd& to) {
  const int first = step == 0 ? 0 : a.waypoints[step - 1];
  const int last = step < a.waypoints.size() ? a.waypoints[step] : a.problem.intervals();
  CollisionChecker* held = a.checkers[(first + last) / 2];
  return held && held->is_free(from) && held->is_free(to) ? *held : scene_states_->before(step);
}

std::optional<DriveByRoute> DriveBySolver::route(const ConfigurationSequence& sequence, const SeededProblem& a,
                                                 bool by_reference_path) {
  if (!guide_)
    guide_.emplace(group_, scene_states_->before(0), start_, goal_near(goal_, start_), options_.seed, monitor_);
  const std::vector<VectorXd> via_points = seeds_.via_points(sequence);
  DriveByRoute route{{start_}, {}};
  VectorXd turns = VectorXd::Zero(start_.size());
  for (std::size_t k = 0; k + 1 < via_points.size(); ++k) {
    const VectorXd from = via_points[k] + turns, to = via_points[k + 1] + turns;
    route.via_points.push_back(to);
    route.ways.emplace_back();
    if (k < steps_.size() && steps_[k].way > 0) continue;  // it has to be straight
    auto way = guide_->way(checker_between(a, k, from, to), from, to, by_reference_path);
    if (!way) return {};
    turns = way->points.back() - via_points[k + 1];
    route.via_points.back() = way->points.back();
    route.ways.back() = std::move(*way);
  }
  // A value that the goal fixes may end full turns away, one in an interval ends in it.
  constexpr double kRounding = 1e-6;
  const VectorXd& end = route.via_points.back();
  for (Eigen::Index i = 0; i < end.size(); ++i) {
    if (goal_.lower[i] == goal_.upper[i]) continue;
    if (end[i] < goal_.lower[i] - kRounding || end[i] > goal_.upper[i] + kRounding) return {};
  }
  return route;
}

}  // namespace mmgrasp::detail
