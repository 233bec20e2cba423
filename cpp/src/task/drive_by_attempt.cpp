#include "task/drive_by_attempt.hpp"

#include <algorithm>
#include <numeric>

#include "task/drive_by_route.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::VectorXd;

constexpr int kCoarse = 35;       // waypoints of a first solution when many are asked for
constexpr double kRefine = 1e-3;  // barrier with which it is refined
constexpr int kShortRefinements = 3;
constexpr double kStill = 0.02;  // of a tool whose pose is kept, along each axis at the waypoints [m/s]
constexpr double kLonger = 1.1;  // than the fingers need to close

/// What a push-grasp asks of the way to a step.
void keep_straight(DriveByAttempt& a, std::size_t segment, const DriveByStep& step, int candidate) {
  WholeBodySegment& way = a.problem.segments[segment];
  const int end = a.problem.segment_end(static_cast<int>(segment));
  for (int k = end - way.intervals + 1; k < end; ++k) a.problem.tool.push_back(constraint_before(step, candidate, k));
  if (step.duration <= 0) return;
  way.min_duration = step.duration;
  way.max_duration = kLonger * step.duration;
}

}  // namespace

VectorXd goal_near(const DriveByGoal& goal, const VectorXd& q) {
  return q.cwiseMax(goal.lower).cwiseMin(goal.upper);
}

double broken(const WholeBodyResult& r) {
  double sum = 0;
  for (const Violation& v : r.violations)
    if (!v.kept()) sum += 1 + v.value;
  return sum;
}

DriveByAttempts::DriveByAttempts(const JointGroup& group, const VectorXd& start, const std::vector<DriveByStep>& steps,
                                 const DriveByGoal& goal, const DriveByOptions& options, DriveByWorlds* worlds,
                                 const Monitor& monitor)
    : group_(group), start_(start), steps_(steps), goal_(goal), options_(options), worlds_(worlds), monitor_(monitor) {}

int DriveByAttempts::collisions(const std::vector<Stand>& chain) {
  if (!worlds_) return 0;
  const DriveByAttempt a = prepared(chain, options_.waypoints, false);
  int count = 0;
  std::size_t step = 0;
  for (int i = 1; i < a.problem.intervals(); ++i) {
    while (step < a.waypoints.size() && i > a.waypoints[step]) ++step;
    count += !worlds_->at(step).is_free(a.guess.positions[static_cast<std::size_t>(i)]);
  }
  return count;
}

WholeBodyResult DriveByAttempts::solve(const std::vector<Stand>& chain, int iterations, std::vector<int>& waypoints) {
  iterations_ = iterations;
  const int few = std::max(kCoarse, 2 + 4 * static_cast<int>(steps_.size()));
  DriveByAttempt a =
      prepared(chain, std::min(options_.waypoints, options_.waypoints > 2 * kCoarse ? few : options_.waypoints));
  WholeBodyResult r = around_obstacles(a, chain);
  if (r.usable() && a.problem.waypoints() < options_.waypoints) {
    DriveByAttempt fine = prepared(chain, options_.waypoints);
    fine.problem.goal_lower = a.problem.goal_lower;
    fine.problem.goal_upper = a.problem.goal_upper;
    std::vector<double> ends;
    for (int s = 0; s < static_cast<int>(a.intervals.size()); ++s)
      ends.push_back(r.trajectory->times()[static_cast<std::size_t>(a.problem.segment_end(s))]);
    fine.guess = resampled(*r.trajectory, ends, fine.intervals);
    fine.guess.free = !fine.checkers.empty();
    const int before = r.iterations;
    r = optimize(fine, kRefine);
    r.iterations += before;
    a = std::move(fine);
  }
  waypoints = a.waypoints;
  return r;
}

WholeBodyResult DriveByAttempts::around_obstacles(DriveByAttempt& a, const std::vector<Stand>& chain) {
  const bool obstacles = worlds_ && group_.has_base() && !worlds_->before(0).world().objects().empty();
  if (obstacles && base_collides(a.checkers, a.guess)) guide(a);
  const WholeBodyResult first = optimize(a);
  if (first.usable() || !obstacles || a.guess.free || monitor_.stopped()) return first;
  const bool collides = std::any_of(first.violations.begin(), first.violations.end(),
                                    [](const Violation& v) { return v.kind == "collision" && !v.kept(); });
  if (!collides) return first;
  DriveByAttempt other = prepared(chain, a.problem.waypoints());
  if (!guide(other)) return first;
  WholeBodyResult second = optimize(other);
  second.iterations += first.iterations;
  if (!second.usable() && broken(second) >= broken(first)) return first;
  a = std::move(other);
  return second;
}

WholeBodyResult DriveByAttempts::optimize(const DriveByAttempt& a, double warm_start) {
  WholeBodyOptions options = options_.trajectory;
  options.warm_start = std::max(options.warm_start, warm_start);
  if (iterations_ < options.max_iterations) {
    options.max_iterations = iterations_;
    options.refinements = std::min(options.refinements, kShortRefinements);
  }
  options.time_limit = std::max(1e-3, std::min(options.time_limit, options_.time_limit - seconds()));
  return optimize_whole_body(a.problem, a.guess, options, a.checkers, monitor_);
}

DriveByAttempt DriveByAttempts::prepared(const std::vector<Stand>& chain, int waypoints, bool checked) {
  DriveByAttempt a{WholeBodyProblem(group_), {start_}, {}, {}, {}, {}, {}};
  for (const Stand& stand : chain) a.knots.push_back(stand.q);
  a.knots.push_back(goal_near(goal_, a.knots.back()));
  a.problem.start = start_;
  a.problem.goal_lower = goal_.lower;
  a.problem.goal_upper = goal_.upper;
  a.problem.jerk_time = options_.jerk_time;
  a.times = segment_times(group_, a.knots);
  a.intervals = share_intervals(waypoints - 1, a.times);
  const bool checkers = worlds_ && checked;
  if (checkers) a.checkers = worlds_->along(a.intervals, chain);
  // A task that takes time is a segment of its own.
  for (std::size_t t = steps_.size(); t-- > 0;) {
    if (steps_[t].dwell <= 0) continue;
    const auto at = static_cast<std::ptrdiff_t>(t) + 1;
    const int end = std::accumulate(a.intervals.begin(), a.intervals.begin() + at, 0);
    if (checkers) a.checkers.insert(a.checkers.begin() + end, kDwellIntervals, &worlds_->at(t));
    a.knots.insert(a.knots.begin() + at, chain[t].q);
    a.intervals.insert(a.intervals.begin() + at, kDwellIntervals);
    a.times.insert(a.times.begin() + at, steps_[t].dwell);
  }
  for (int n : a.intervals) a.problem.segments.push_back({n});
  for (std::size_t t = 0, s = 0; t < steps_.size(); ++t, ++s) {
    a.waypoints.push_back(a.problem.segment_end(static_cast<int>(s)));
    a.problem.tool.push_back(constraint_at(steps_[t], chain[t].candidate, a.waypoints.back()));
    if (steps_[t].way > 0) keep_straight(a, s, steps_[t], chain[t].candidate);
    if (steps_[t].dwell <= 0) continue;
    a.problem.segments[++s].min_duration = steps_[t].dwell;
    a.problem.tool.back().velocity_lower.setConstant(-kStill);
    a.problem.tool.back().velocity_upper.setConstant(kStill);
    for (int k = 1; k <= kDwellIntervals; ++k) {
      a.problem.tool.push_back(a.problem.tool.back());
      ++a.problem.tool.back().waypoint;
    }
  }
  a.guess = guess_through(group_, a.knots, a.intervals, a.times);
  return a;
}

bool DriveByAttempts::guide(DriveByAttempt& a) {
  std::vector<GuidedBase> guides;
  std::size_t step = 0;
  for (std::size_t k = 0; k + 1 < a.knots.size(); ++k) {
    guides.emplace_back();
    if ((a.knots[k + 1] - a.knots[k]).head<2>().norm() < 1e-9) continue;  // a task that takes time
    const std::size_t to = step++;
    if (to < steps_.size() && steps_[to].way > 0) continue;
    guides[k] = guided_base(group_, worlds_->at(to), a.knots[k], a.knots[k + 1], monitor_);
    if (guides[k].poses.empty()) return false;
    a.times[k] = std::max(a.times[k], 1.1 * drive_time(group_, guides[k].poses));
    // The way may take a full turn: everything after it is that much further round.
    const double turn = guides[k].poses.back()[2] - a.knots[k + 1][2];
    for (std::size_t later = k + 1; later < a.knots.size(); ++later) a.knots[later][2] += turn;
    a.problem.goal_lower[2] += turn;
    a.problem.goal_upper[2] += turn;
  }
  a.guess = guess_through(group_, a.knots, a.intervals, a.times, guides);
  a.guess.free = true;
  return true;
}

}  // namespace mmgrasp::detail
