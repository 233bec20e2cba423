#include "mmgrasp/task/drive_by.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <sstream>

#include "mmgrasp/core/error.hpp"
#include "task/drive_by_guess.hpp"
#include "task/drive_by_route.hpp"
#include "task/drive_by_stands.hpp"
#include "task/drive_by_worlds.hpp"

namespace mmgrasp {
namespace {

using Eigen::VectorXd;

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr int kDwellIntervals = 4;
constexpr int kCoarse = 35;       // waypoints of a first solution when many are asked for
constexpr double kRefine = 1e-3;  // barrier with which it is refined

void check_tasks(const std::vector<DriveByTask>& tasks, const World& world) {
  for (std::size_t i = 0; i < tasks.size(); ++i) {
    const std::string field = "tasks[" + std::to_string(i) + "]";
    const DriveByTask& task = tasks[i];
    require(!task.candidates.empty(), field + ".candidates", 0, "must hold at least one pose");
    for (std::size_t c = 0; c < task.candidates.size(); ++c)
      checked_pose(task.candidates[c].matrix(), field + ".candidates[" + std::to_string(c) + "]");
    for (int k = 0; k < 6; ++k) {
      require(task.tolerance[k] >= 0 && std::isfinite(task.tolerance[k]),
              field + ".tolerance[" + std::to_string(k) + "]", task.tolerance[k], "must be at least 0 and finite");
    }
    require(task.free.size() == 6, field + ".free", static_cast<double>(task.free.size()), "must have 6 entries");
    require(task.max_tool_speed > 0, field + ".max_tool_speed", task.max_tool_speed, "must be positive");
    require(task.object.empty() || world.objects().count(task.object) > 0, field + ".object", "'" + task.object + "'",
            "must be an object of the world");
    require(task.dwell >= 0 && std::isfinite(task.dwell), field + ".dwell", task.dwell, "must be at least 0");
  }
}

ToolConstraint constraint_of(const DriveByTask& task, int candidate, int waypoint) {
  ToolConstraint tool;
  tool.waypoint = waypoint;
  tool.T_world_tip = task.candidates[static_cast<std::size_t>(candidate)];
  for (int k = 0; k < 6; ++k) {
    const double slack = task.free[static_cast<std::size_t>(k)] ? kInf : task.tolerance[k];
    tool.lower[k] = -slack;
    tool.upper[k] = slack;
  }
  tool.max_speed = task.max_tool_speed;
  return tool;
}

/// A configuration in the goal's box, near the start.
VectorXd goal_near(const DriveByGoal& goal, const VectorXd& start) {
  return start.cwiseMax(goal.lower).cwiseMin(goal.upper);
}

std::string number(double value) {
  std::ostringstream out;
  out.precision(3);
  out << value;
  return out.str();
}

std::string describe(const WholeBodyResult& r) {
  std::string text =
      std::string(to_string(r.outcome)) + " after " + std::to_string(r.iterations) + " iterations (" + r.message + ")";
  for (const Violation& v : r.violations) {
    if (v.kept()) continue;
    text += "; " + v.kind + " (" + v.what + ") broken by " + number(v.value) + " " + v.unit + " at waypoint " +
            std::to_string(v.waypoint) + ", " + number(v.time) + " s";
  }
  return text;
}

double broken(const WholeBodyResult& r) {
  double sum = 0;
  for (const Violation& v : r.violations)
    if (!v.kept()) sum += 1 + v.value;
  return sum;
}

std::vector<DriveByEvent> events_of(const WholeBodyTrajectory& t, const std::vector<int>& waypoints,
                                    const std::vector<detail::Stand>& chain) {
  std::vector<DriveByEvent> events;
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    const std::size_t at = static_cast<std::size_t>(waypoints[i]);
    const VectorXd rate = configuration_velocity(t.group(), t.positions()[at], t.drive()[at]);
    DriveByEvent e;
    e.waypoint = waypoints[i];
    e.time = t.times()[at];
    e.candidate = chain[i].candidate;
    e.base_speed = t.group().has_base() ? rate.head<2>().norm() : 0;
    e.tool_speed = (t.group().jacobian(t.positions()[at]) * rate).head<3>().norm();
    events.push_back(e);
  }
  return events;
}

/// One plan: keeps what the attempts share.
class DriveBy {
 public:
  DriveBy(const JointGroup& group, const World& world, const VectorXd& start, const std::vector<DriveByTask>& tasks,
          const DriveByGoal& goal, const DriveByOptions& options, const Monitor& monitor)
      : group_(group), start_(start), tasks_(tasks), goal_(goal), options_(options), monitor_(monitor) {
    if (options.collisions) worlds_.emplace(group, world, tasks);
    for (int i = 0; i < group.size(); ++i) {
      if (!group.wraps()[static_cast<std::size_t>(i)]) continue;
      if (goal_.lower[i] != goal_.upper[i]) continue;
      goal_.lower[i] = goal_.upper[i] = start[i] + wrap_angle(goal_.lower[i] - start[i]);
    }
  }

  DriveByResult run() {
    DriveByResult result;
    if (const auto touching = worlds_ ? worlds_->before(0).first_contact(start_) : std::nullopt) {
      const Contact c = *touching;
      result.outcome = Outcome::invalid_start;
      result.report = "start: '" + c.a + "' touches '" + c.b + "'";
      return result;
    }
    std::string missing;
    const auto chains = find_chains(missing);
    if (chains.empty()) {
      result.outcome = monitor_.stopped() ? Outcome::stopped : Outcome::infeasible;
      result.report = missing;
      return result;
    }
    attempt_all(chains, result);
    return result;
  }

  std::optional<DriveByStart> first_guess() {
    std::string missing;
    const auto chains = find_chains(missing);
    if (chains.empty()) return {};
    Attempt a = prepared(chains.front(), options_.waypoints);
    return DriveByStart{std::move(a.problem), std::move(a.guess)};
  }

  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count(); }

 private:
  struct Attempt {
    WholeBodyProblem problem;
    std::vector<VectorXd> knots;
    std::vector<int> intervals, waypoints;
    std::vector<double> times;
    std::vector<CollisionChecker*> checkers;
    WholeBodyGuess guess;
  };

  std::vector<std::vector<detail::Stand>> find_chains(std::string& missing) {
    if (tasks_.empty()) return {{}};
    const VectorXd goal = goal_near(goal_, start_);
    std::vector<std::vector<detail::Stand>> stands;
    for (std::size_t i = 0; i < tasks_.size(); ++i) {
      const VectorXd before = rough(static_cast<int>(i) - 1, goal), after = rough(static_cast<int>(i) + 1, goal);
      stands.push_back(detail::find_stands(group_, worlds_ ? &worlds_->at(i) : nullptr, tasks_[i], before, after,
                                           options_, static_cast<unsigned>(i), monitor_));
      if (!stands.back().empty()) continue;
      missing = "task " + std::to_string(i) + ": no configuration within the limits" +
                (worlds_ ? " and free of collisions" : "") + " brings the tool there (" +
                std::to_string(options_.stands) + " tries at a time)";
      return {};
    }
    return detail::choose_stands(group_, stands, start_, goal, options_.attempts);
  }

  /// Where the robot is about at a task, before anything is known: the base below the tool.
  VectorXd rough(int task, const VectorXd& goal) const {
    if (task < 0) return start_;
    if (task >= static_cast<int>(tasks_.size())) return goal;
    VectorXd q = 0.5 * (start_ + goal);
    if (group_.has_base()) q.head<2>() = tasks_[static_cast<std::size_t>(task)].candidates[0].translation().head<2>();
    return q;
  }

  void attempt_all(const std::vector<std::vector<detail::Stand>>& chains, DriveByResult& result) {
    int solutions = 0;
    double least_broken = kInf;
    for (const auto& chain : chains) {
      if (seconds() > options_.time_limit || monitor_.stopped()) break;
      monitor_.report("attempts", static_cast<double>(result.attempts) / static_cast<double>(chains.size()));
      std::vector<int> waypoints;
      const WholeBodyResult r = attempt(chain, waypoints);
      ++result.attempts;
      result.iterations += r.iterations;
      result.report += "attempt " + std::to_string(result.attempts) + ": " + describe(r) +
                       (r.usable() ? ", " + number(r.trajectory->duration()) + " s" : "") + "\n";
      const bool better = r.usable() ? !result.usable() || r.trajectory->duration() < result.duration()
                                     : !result.usable() && broken(r) < least_broken;
      if (better) {
        if (!r.usable()) least_broken = broken(r);
        result.outcome = r.outcome;
        result.trajectory = r.trajectory;
        result.violations = r.violations;
        result.events = events_of(*r.trajectory, waypoints, chain);
      }
      if (r.usable() && ++solutions >= options_.solutions) break;
    }
    if (!result.usable()) {
      if (monitor_.stopped())
        result.outcome = Outcome::stopped;
      else if (seconds() > options_.time_limit)
        result.outcome = Outcome::timeout;
    }
  }

  /// Straight through the stands, and around obstacles when that fails or is bound to; many waypoints start from the
  /// solution with few.
  WholeBodyResult attempt(const std::vector<detail::Stand>& chain, std::vector<int>& waypoints) {
    const int few = std::max(kCoarse, 2 + 4 * static_cast<int>(tasks_.size()));
    Attempt a =
        prepared(chain, std::min(options_.waypoints, options_.waypoints > 2 * kCoarse ? few : options_.waypoints));
    WholeBodyResult r = around_obstacles(a, chain);
    if (r.usable() && a.problem.waypoints() < options_.waypoints) {
      Attempt fine = prepared(chain, options_.waypoints);
      fine.problem.goal_lower = a.problem.goal_lower;
      fine.problem.goal_upper = a.problem.goal_upper;
      std::vector<double> ends;
      for (int s = 0; s < static_cast<int>(a.intervals.size()); ++s)
        ends.push_back(r.trajectory->times()[static_cast<std::size_t>(a.problem.segment_end(s))]);
      fine.guess = detail::resampled(*r.trajectory, ends, fine.intervals);
      fine.guess.free = !fine.checkers.empty();
      const int before = r.iterations;
      r = optimize(fine, kRefine);
      r.iterations += before;
      a = std::move(fine);
    }
    waypoints = a.waypoints;
    return r;
  }

  WholeBodyResult around_obstacles(Attempt& a, const std::vector<detail::Stand>& chain) {
    const bool obstacles = worlds_ && group_.has_base() && !worlds_->before(0).world().objects().empty();
    if (obstacles && detail::base_collides(a.checkers, a.guess)) guide(a);
    const WholeBodyResult first = optimize(a);
    if (first.usable() || !obstacles || a.guess.free || monitor_.stopped()) return first;
    const bool collides = std::any_of(first.violations.begin(), first.violations.end(),
                                      [](const Violation& v) { return v.kind == "collision" && !v.kept(); });
    if (!collides) return first;
    Attempt other = prepared(chain, a.problem.waypoints());
    if (!guide(other)) return first;
    WholeBodyResult second = optimize(other);
    second.iterations += first.iterations;
    if (!second.usable() && broken(second) >= broken(first)) return first;
    a = std::move(other);
    return second;
  }

  WholeBodyResult optimize(const Attempt& a, double warm_start = 0) {
    WholeBodyOptions options = options_.trajectory;
    options.warm_start = std::max(options.warm_start, warm_start);
    options.time_limit = std::max(1e-3, options_.time_limit - seconds());
    return optimize_whole_body(a.problem, a.guess, options, a.checkers, monitor_);
  }

  Attempt prepared(const std::vector<detail::Stand>& chain, int waypoints) {
    Attempt a{WholeBodyProblem(group_), {start_}, {}, {}, {}, {}, {}};
    for (const detail::Stand& stand : chain) a.knots.push_back(stand.q);
    a.knots.push_back(goal_near(goal_, a.knots.back()));
    a.problem.start = start_;
    a.problem.goal_lower = goal_.lower;
    a.problem.goal_upper = goal_.upper;
    a.problem.jerk_time = options_.jerk_time;
    a.times = detail::segment_times(group_, a.knots);
    a.intervals = detail::share_intervals(waypoints - 1, a.times);
    if (worlds_) a.checkers = worlds_->along(a.intervals, chain);
    // A task that takes time is a segment of its own.
    for (std::size_t t = tasks_.size(); t-- > 0;) {
      if (tasks_[t].dwell <= 0) continue;
      const auto at = static_cast<std::ptrdiff_t>(t) + 1;
      const int end = std::accumulate(a.intervals.begin(), a.intervals.begin() + at, 0);
      if (worlds_) a.checkers.insert(a.checkers.begin() + end, kDwellIntervals, &worlds_->at(t));
      a.knots.insert(a.knots.begin() + at, chain[t].q);
      a.intervals.insert(a.intervals.begin() + at, kDwellIntervals);
      a.times.insert(a.times.begin() + at, tasks_[t].dwell);
    }
    for (int n : a.intervals) a.problem.segments.push_back({n});
    for (std::size_t t = 0, s = 0; t < tasks_.size(); ++t, ++s) {
      a.waypoints.push_back(a.problem.segment_end(static_cast<int>(s)));
      a.problem.tool.push_back(constraint_of(tasks_[t], chain[t].candidate, a.waypoints.back()));
      if (tasks_[t].dwell <= 0) continue;
      a.problem.segments[++s].min_duration = tasks_[t].dwell;
      for (int k = 1; k <= kDwellIntervals; ++k) {
        a.problem.tool.push_back(a.problem.tool.back());
        ++a.problem.tool.back().waypoint;
      }
    }
    a.guess = detail::guess_through(group_, a.knots, a.intervals, a.times);
    return a;
  }

  /// Leads the base around obstacles; false when no way was found.
  bool guide(Attempt& a) {
    std::vector<detail::GuidedBase> guides;
    std::size_t task = 0;
    for (std::size_t k = 0; k + 1 < a.knots.size(); ++k) {
      guides.emplace_back();
      if ((a.knots[k + 1] - a.knots[k]).head<2>().norm() < 1e-9) continue;  // a task that takes time
      guides[k] = detail::guided_base(group_, worlds_->at(task), a.knots[k], a.knots[k + 1], monitor_);
      ++task;
      if (guides[k].poses.empty()) return false;
      a.times[k] = std::max(a.times[k], 1.1 * detail::drive_time(group_, guides[k].poses));
      // The way may take a full turn: everything after it is that much further round.
      const double turn = guides[k].poses.back()[2] - a.knots[k + 1][2];
      for (std::size_t later = k + 1; later < a.knots.size(); ++later) a.knots[later][2] += turn;
      a.problem.goal_lower[2] += turn;
      a.problem.goal_upper[2] += turn;
    }
    a.guess = detail::guess_through(group_, a.knots, a.intervals, a.times, guides);
    a.guess.free = true;
    return true;
  }

  const JointGroup& group_;
  VectorXd start_;
  const std::vector<DriveByTask>& tasks_;
  DriveByGoal goal_;
  const DriveByOptions& options_;
  const Monitor& monitor_;
  std::optional<detail::DriveByWorlds> worlds_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace

void DriveByOptions::check() const {
  require(waypoints >= 2, "waypoints", waypoints, "must be at least 2");
  require(attempts > 0, "attempts", attempts, "must be positive");
  require(solutions > 0, "solutions", solutions, "must be positive");
  require(stands > 0, "stands", stands, "must be positive");
  require(time_limit > 0, "time_limit", time_limit, "must be positive");
  require(jerk_time >= 0 && std::isfinite(jerk_time), "jerk_time", jerk_time, "must be at least 0");
  require(threads >= 0, "threads", threads, "must be at least 0");
  trajectory.check();
}

namespace {

void check_call(const JointGroup& group, const World& world, const VectorXd& start,
                const std::vector<DriveByTask>& tasks, const DriveByGoal& goal, const DriveByOptions& options) {
  options.check();
  check_tasks(tasks, world);
  const int least = 2 + 2 * static_cast<int>(tasks.size());
  require(options.waypoints >= least, "waypoints", options.waypoints,
          "must be at least " + std::to_string(least) + " for " + std::to_string(tasks.size()) + " tasks");
  WholeBodyProblem ends(group);
  ends.start = start;
  ends.goal_lower = goal.lower;
  ends.goal_upper = goal.upper;
  ends.segments = {{1}};
  ends.check();
}

}  // namespace

DriveByResult plan_drive_by(const JointGroup& group, const World& world, const VectorXd& start,
                            const std::vector<DriveByTask>& tasks, const DriveByGoal& goal,
                            const DriveByOptions& options, const Monitor& monitor) {
  check_call(group, world, start, tasks, goal, options);
  DriveBy plan(group, world, start, tasks, goal, options, monitor);
  DriveByResult result = plan.run();
  result.seconds = plan.seconds();
  return result;
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

}  // namespace mmgrasp
