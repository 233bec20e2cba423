#include "task/drive_by/drive_by_solve.hpp"

#include <algorithm>
#include <numeric>

#include "task/drive_by/drive_by_route.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::VectorXd;

constexpr int kCoarse = 35;       // waypoints of a first solution
constexpr int kMany = 150;        // when more than these are asked for
constexpr double kRefine = 1e-3;  // barrier with which it is refined
constexpr double kStill = 0.02;   // of a tool whose pose is kept, along each axis at the waypoints [m/s]
constexpr double kLonger = 1.1;   // than the fingers need to close

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
    count += !worlds_->at(step).is_free(a.guess.positions[i]);
  }
  return count;
}

WholeBodyResult DriveByAttempts::solve(const std::vector<Stand>& chain, const DriveByPatience& patience,
                                       std::vector<int>& waypoints) {
  iterations_ = patience.iterations;
  const int few = std::max(kCoarse, 2 + 4 * static_cast<int>(steps_.size()));
  DriveByAttempt a =
      prepared(chain, std::min(options_.waypoints, options_.waypoints > kMany ? few : options_.waypoints));
  lead_around_obstacles(a, chain, patience);
  WholeBodyResult r = optimize(a);
  if (r.usable() && a.problem.waypoints() < options_.waypoints) {
    DriveByAttempt fine = prepared(chain, options_.waypoints);
    fine.problem.goal_lower = a.problem.goal_lower;
    fine.problem.goal_upper = a.problem.goal_upper;
    std::vector<double> ends;
    for (int s = 0; s < static_cast<int>(a.intervals.size()); ++s)
      ends.push_back(r.trajectory->times()[a.problem.segment_end(s)]);
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

void DriveByAttempts::lead_around_obstacles(DriveByAttempt& a, const std::vector<Stand>& chain,
                                            const DriveByPatience& patience) {
  if (!worlds_ || (!patience.guided && collisions(chain) == 0)) return;
  const std::optional<DriveByRoute> way = route(chain, a, patience.by_road);
  if (way) a = prepared(chain, a.problem.waypoints(), true, &*way);
}

WholeBodyResult DriveByAttempts::optimize(const DriveByAttempt& a, double warm_start) {
  WholeBodyOptions options = options_.trajectory;
  options.warm_start = std::max(options.warm_start, warm_start);
  options.max_iterations = std::min(options.max_iterations, iterations_);
  options.time_limit = std::max(1e-3, std::min(options.time_limit, options_.time_limit - seconds()));
  return optimize_whole_body(a.problem, a.guess, options, a.checkers, monitor_);
}

DriveByAttempt DriveByAttempts::prepared(const std::vector<Stand>& chain, int waypoints, bool checked,
                                         const DriveByRoute* route) {
  DriveByAttempt a{WholeBodyProblem(group_), knots_of(chain), {}, {}, {}, {}, {}};
  a.problem.start = start_;
  a.problem.goal_lower = goal_.lower;
  a.problem.goal_upper = goal_.upper;
  a.problem.jerk_time = options_.jerk_time;
  a.times = segment_times(group_, a.knots);
  std::vector<GuidedWay> ways;
  if (route) {
    // A way may take full turns: the goal is that much further round.
    const VectorXd turns = route->knots.back() - a.knots.back();
    a.problem.goal_lower += turns;
    a.problem.goal_upper += turns;
    a.knots = route->knots;
    ways = route->ways;
    for (std::size_t k = 0; k < ways.size(); ++k)
      if (!ways[k].points.empty()) a.times[k] = std::max(a.times[k], 1.1 * ways[k].times.back());
  }
  a.intervals = share_intervals(waypoints - 1, a.times);
  const bool checkers = worlds_ && checked;
  if (checkers) a.checkers = worlds_->along(a.intervals, chain);
  // A task that takes time is a segment of its own.
  for (std::size_t t = steps_.size(); t-- > 0;) {
    if (steps_[t].dwell <= 0) continue;
    const auto at = static_cast<std::ptrdiff_t>(t) + 1;
    const int end = std::accumulate(a.intervals.begin(), a.intervals.begin() + at, 0);
    if (checkers) a.checkers.insert(a.checkers.begin() + end, kDwellIntervals, &worlds_->at(t));
    a.knots.insert(a.knots.begin() + at, VectorXd(a.knots[t + 1]));
    if (route) ways.insert(ways.begin() + at, GuidedWay());
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
  a.guess = guess_through(group_, a.knots, a.intervals, a.times, ways);
  a.guess.free = route != nullptr;
  return a;
}

std::vector<VectorXd> DriveByAttempts::knots_of(const std::vector<Stand>& chain) const {
  std::vector<VectorXd> knots{start_};
  for (const Stand& stand : chain) knots.push_back(stand.q);
  knots.push_back(goal_near(goal_, knots.back()));
  return knots;
}

CollisionChecker& DriveByAttempts::checker_between(const DriveByAttempt& a, std::size_t step, const VectorXd& from,
                                                   const VectorXd& to) {
  const int first = step == 0 ? 0 : a.waypoints[step - 1];
  const int last = step < a.waypoints.size() ? a.waypoints[step] : a.problem.intervals();
  CollisionChecker* held = a.checkers[(first + last) / 2];
  return held && held->is_free(from) && held->is_free(to) ? *held : worlds_->at(step);
}

std::optional<DriveByRoute> DriveByAttempts::route(const std::vector<Stand>& chain, const DriveByAttempt& a,
                                                   bool by_road) {
  if (!roads_) roads_.emplace(group_, worlds_->before(0), start_, goal_near(goal_, start_), options_.seed, monitor_);
  const std::vector<VectorXd> knots = knots_of(chain);
  DriveByRoute route{{start_}, {}};
  VectorXd turns = VectorXd::Zero(start_.size());
  for (std::size_t k = 0; k + 1 < knots.size(); ++k) {
    const VectorXd from = knots[k] + turns, to = knots[k + 1] + turns;
    route.knots.push_back(to);
    route.ways.emplace_back();
    if (k < steps_.size() && steps_[k].way > 0) continue;  // it has to be straight
    auto way = roads_->way(checker_between(a, k, from, to), from, to, by_road);
    if (!way) return {};
    turns = way->points.back() - knots[k + 1];
    route.knots.back() = way->points.back();
    route.ways.back() = std::move(*way);
  }
  return route;
}

}  // namespace mmgrasp::detail
