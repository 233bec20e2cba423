#include "task/drive_by/drive_by_seed.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace mmgrasp::detail {
namespace {

using Eigen::VectorXd;

constexpr double kStill = 0.02;  // speed of a tool whose pose is kept, along each axis at the waypoints [m/s]
constexpr double kLonger = 1.1;  // factor on a dwell and on the time that the fingers need to close

/// What a push-grasp asks of the way to a step.
void keep_straight(SeededProblem& a, std::size_t segment, const DriveByStep& step, int candidate) {
  WholeBodySegment& way = a.problem.segments[segment];
  const int end = a.problem.segment_end(static_cast<int>(segment));
  for (int k = end - way.intervals + 1; k < end; ++k) a.problem.tool.push_back(constraint_before(step, candidate, k));
  if (step.duration <= 0) return;
  way.min_duration = step.duration;
  way.max_duration = kLonger * step.duration;
}

}  // namespace

int dwell_intervals(double dwell) {
  constexpr double kLongest = 0.12, kFewest = 5;  // [s]
  constexpr double kMostIntervals = 100;
  return static_cast<int>(std::clamp(std::ceil(dwell / kLongest), kFewest, kMostIntervals));
}

VectorXd goal_near(const DriveByGoal& goal, const VectorXd& q) {
  return q.cwiseMax(goal.lower).cwiseMin(goal.upper);
}

DriveBySeeds::DriveBySeeds(const JointGroup& group, const VectorXd& start, const std::vector<DriveByStep>& steps,
                           const DriveByGoal& goal, const DriveByOptions& options, SceneStates* scene_states)
    : group_(group), start_(start), steps_(steps), goal_(goal), options_(options), scene_states_(scene_states) {}

SeededProblem DriveBySeeds::make(const ConfigurationSequence& sequence, int waypoints, bool checked,
                                 const DriveByRoute* route) {
  SeededProblem a{WholeBodyProblem(group_), via_points(sequence), {}, {}, {}, {}, {}};
  a.problem.start = start_;
  a.problem.goal_lower = goal_.lower;
  a.problem.goal_upper = goal_.upper;
  a.problem.jerk_time = options_.jerk_time;
  a.times = segment_times(group_, a.via_points);
  std::vector<GuidedWay> ways;
  if (route) {
    // A way may take full turns: what the goal fixes is that much further round.
    for (Eigen::Index i = 0; i < start_.size(); ++i) {
      if (goal_.lower[i] != goal_.upper[i]) continue;
      const double turns = route->via_points.back()[i] - a.via_points.back()[i];
      a.problem.goal_lower[i] += turns;
      a.problem.goal_upper[i] += turns;
    }
    a.via_points = route->via_points;
    ways = route->ways;
    for (std::size_t k = 0; k < ways.size(); ++k)
      if (!ways[k].points.empty()) a.times[k] = std::max(a.times[k], 1.1 * ways[k].times.back());
  }
  a.intervals = share_intervals(waypoints - 1, a.times);
  const bool checkers = scene_states_ && checked;
  if (checkers) a.checkers = scene_states_->along(a.intervals, sequence);
  // A task that takes time is a segment of its own.
  for (std::size_t t = steps_.size(); t-- > 0;) {
    if (steps_[t].dwell <= 0) continue;
    const auto at = static_cast<std::ptrdiff_t>(t) + 1;
    const int end = std::accumulate(a.intervals.begin(), a.intervals.begin() + at, 0);
    const int intervals = dwell_intervals(steps_[t].dwell);
    if (checkers) a.checkers.insert(a.checkers.begin() + end, intervals, &scene_states_->at(t));
    a.via_points.insert(a.via_points.begin() + at, VectorXd(a.via_points[t + 1]));
    if (route) ways.insert(ways.begin() + at, GuidedWay());
    a.intervals.insert(a.intervals.begin() + at, intervals);
    a.times.insert(a.times.begin() + at, steps_[t].dwell);
  }
  for (int n : a.intervals) a.problem.segments.push_back({n});
  for (std::size_t t = 0, s = 0; t < steps_.size(); ++t, ++s) {
    a.waypoints.push_back(a.problem.segment_end(static_cast<int>(s)));
    a.problem.tool.push_back(constraint_at(steps_[t], sequence[t].candidate, a.waypoints.back()));
    if (steps_[t].way > 0) keep_straight(a, s, steps_[t], sequence[t].candidate);
    if (steps_[t].dwell <= 0) continue;
    a.problem.segments[++s].min_duration = steps_[t].dwell;
    a.problem.segments[s].max_duration = kLonger * steps_[t].dwell;
    a.problem.tool.back().velocity_lower.setConstant(-kStill);
    a.problem.tool.back().velocity_upper.setConstant(kStill);
    for (int k = 0; k < dwell_intervals(steps_[t].dwell); ++k) {
      a.problem.tool.push_back(a.problem.tool.back());
      ++a.problem.tool.back().waypoint;
    }
  }
  a.guess = guess_through(group_, a.via_points, a.intervals, a.times, ways);
  a.guess.collision_free = route != nullptr;
  return a;
}

std::vector<VectorXd> DriveBySeeds::via_points(const ConfigurationSequence& sequence) const {
  std::vector<VectorXd> points{start_};
  for (const StepConfiguration& configuration : sequence) points.push_back(configuration.q);
  points.push_back(goal_near(goal_, points.back()));
  return points;
}

}  // namespace mmgrasp::detail
