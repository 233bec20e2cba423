#include "mmgrasp/plan/time_parameterization.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "plan/timing/blended_path.hpp"
#include "plan/timing/jerk_limit.hpp"
#include "plan/timing/path_deviation.hpp"
#include "plan/timing/path_timing.hpp"
#include "plan/timing/timing_stop.hpp"
#include "plan/timing/trajectory_sampling.hpp"

namespace mmgrasp {
namespace {

using Waypoints = std::vector<Eigen::VectorXd>;

constexpr double kPlannedShare = 0.999;      // Share of the limits planned for: cubics between samples need the rest.
constexpr double kSmallestDeviation = 1e-5;  // Corners that must be passed closer than this [rad] are stopped at.
constexpr double kLeastAccelerationShare = 0.05;  // With jerk limits, shares of the acceleration limits from 1 down to
constexpr double kShareStep = 0.7;                // this one are tried, each this many times the one before.
constexpr double kRounding = 1e-9;                // Limit overshoot that is nothing but rounding [rad or m].
constexpr double kSlack = 1e-6;                   // Relative slack of the final check.

void check_limits(const Eigen::VectorXd& limits, Eigen::Index size, const std::string& field) {
  require(limits.size() == size, field, static_cast<double>(limits.size()),
          "must have one entry per joint (" + std::to_string(size) + ")");
  for (Eigen::Index i = 0; i < size; ++i) {
    require_positive(limits[i], field + "[" + std::to_string(i) + "]", "", std::numeric_limits<double>::max());
  }
}

void check_path(const JointPath& path) {
  require(!path.waypoints.empty(), "path.waypoints", "[]", "must hold at least one waypoint");
  const Eigen::Index size = path.waypoints.front().size();
  for (std::size_t i = 0; i < path.waypoints.size(); ++i) {
    const std::string field = "path.waypoints[" + std::to_string(i) + "]";
    require(path.waypoints[i].size() == size, field, static_cast<double>(path.waypoints[i].size()),
            "must have as many values as the first waypoint (" + std::to_string(size) + ")");
    require_numbers(path.waypoints[i], field, "rad or m");
  }
}

Waypoints without_repeats(const Waypoints& waypoints) {
  Waypoints kept{waypoints.front()};
  for (std::size_t i = 1; i < waypoints.size(); ++i) {
    if ((waypoints[i] - kept.back()).norm() > 1e-9) kept.push_back(waypoints[i]);
  }
  return kept;
}

JointTrajectory at_rest(const Eigen::VectorXd& q) {
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(q.size());
  JointTrajectory trajectory;
  trajectory.times = {0};
  trajectory.positions = {q};
  trajectory.velocities = {zero};
  trajectory.accelerations = {zero};
  return trajectory;
}

void check_samples(const JointTrajectory& trajectory, const Eigen::VectorXd& velocity_limits,
                   const Eigen::VectorXd& acceleration_limits) {
  for (std::size_t i = 0; i < trajectory.times.size(); ++i) {
    const bool kept = (trajectory.velocities[i].cwiseAbs() - velocity_limits * (1 + kSlack)).maxCoeff() <= 0 &&
                      (trajectory.accelerations[i].cwiseAbs() - acceleration_limits * (1 + kSlack)).maxCoeff() <= 0;
    const bool ordered = i == 0 || trajectory.times[i] > trajectory.times[i - 1];
    if (!kept || !ordered) {
      throw Error("time parameterization: sample " + std::to_string(i) + " breaks a limit or the order of time");
    }
  }
}

/// A path with its limits, to be timed for any deviations at its corners. Timing throws TimingStopped.
class TimedPath {
 public:
  TimedPath(Waypoints waypoints, Eigen::VectorXd velocity_limits, Eigen::VectorXd acceleration_limits,
            const TimingOptions& options, const Monitor& monitor)
      : waypoints_(std::move(waypoints)),
        velocity_limits_(std::move(velocity_limits)),
        acceleration_limits_(std::move(acceleration_limits)),
        jerk_limits_(options.jerk_limits),
        period_(options.sample_period),
        monitor_(monitor) {}

  /// One deviation per inner waypoint.
  JointTrajectory trajectory(const std::vector<double>& deviations) const {
    if (waypoints_.size() < 2) return at_rest(waypoints_.front());
    monitor_.report("time path", 0);
    JointTrajectory result =
        jerk_limits_.size() == 0 ? fastest(detail::BlendedPath(waypoints_, deviations), 1) : smoothest(deviations);
    result.positions.front() = waypoints_.front();
    result.positions.back() = waypoints_.back();
    result.velocities.front().setZero();
    result.velocities.back().setZero();
    check_samples(result, velocity_limits_, acceleration_limits_);
    return result;
  }

  JointTrajectory fastest(const detail::BlendedPath& path, double acceleration_share) const {
    const Eigen::VectorXd accelerations = acceleration_share * acceleration_limits_;
    const detail::PathTiming timing(path, kPlannedShare * velocity_limits_, kPlannedShare * accelerations,
                                    monitor_.stop);
    return detail::sample_trajectory(timing, velocity_limits_, accelerations, period_);
  }

  /// The quickest of motions under several shares of the acceleration limits: under tight jerk limits lower
  /// accelerations may take less time, and cut corners less.
  JointTrajectory smoothest(const std::vector<double>& deviations) const {
    JointTrajectory best;
    for (double share = 1; share > kLeastAccelerationShare; share *= kShareStep) {
      monitor_.report("limit jerk", std::log(share) / std::log(kLeastAccelerationShare));
      improve(best, share, deviations);
    }
    return best;
  }

  /// Averaging cuts corners by more than their arcs do: arcs become tighter, and stops at last, until what is allowed
  /// holds. A motion that is not quicker than `best` before that is given up.
  void improve(JointTrajectory& best, double share, const std::vector<double>& allowed) const {
    std::vector<double> deviations = allowed;
    for (;;) {
      const JointTrajectory fast = fastest(detail::BlendedPath(waypoints_, deviations), share);
      if (!best.times.empty() && fast.duration() >= best.duration()) return;  // Limiting its jerk takes time.
      JointTrajectory trial =
          detail::limit_jerk(fast, velocity_limits_, acceleration_limits_, jerk_limits_, period_, monitor_.stop);
      if (!best.times.empty() && trial.duration() >= best.duration()) return;
      const bool unchanged = trial.times == fast.times;
      if (unchanged || detail::keeps_deviation(trial, waypoints_, allowed, deviations, monitor_.stop)) {
        best = std::move(trial);
        return;
      }
    }
  }

  std::size_t corner_count() const { return waypoints_.size() < 2 ? 0 : waypoints_.size() - 2; }

  /// The inner waypoint nearest to q.
  std::size_t nearest_corner(const Eigen::VectorXd& q) const {
    std::size_t nearest = 0;
    for (std::size_t i = 1; i < corner_count(); ++i) {
      if ((waypoints_[i + 1] - q).squaredNorm() < (waypoints_[nearest + 1] - q).squaredNorm()) nearest = i;
    }
    return nearest;
  }

 private:
  Waypoints waypoints_;
  Eigen::VectorXd velocity_limits_, acceleration_limits_, jerk_limits_;
  double period_;
  const Monitor& monitor_;
};

/// Configurations at which the interpolated trajectory is not free, checked in steps in which no joint moves more
/// than `step`; at most one per interval between samples. Throws TimingStopped.
Waypoints blocked_configurations(CollisionChecker& checker, const JointTrajectory& trajectory, double step,
                                 const Monitor& monitor) {
  const Eigen::VectorXd& lower = checker.group().lower();
  const Eigen::VectorXd& upper = checker.group().upper();
  Waypoints blocked;
  const auto free = [&](Eigen::VectorXd q) {
    const Eigen::VectorXd inside = q.cwiseMax(lower).cwiseMin(upper);
    if ((inside - q).cwiseAbs().maxCoeff() <= kRounding) q = inside;
    return checker.is_free(q);
  };
  if (!free(trajectory.positions.front())) blocked.push_back(trajectory.positions.front());
  for (std::size_t i = 0; i + 1 < trajectory.times.size(); ++i) {
    monitor.report("check timed path", static_cast<double>(i) / static_cast<double>(trajectory.times.size()));
    const double h = trajectory.times[i + 1] - trajectory.times[i];
    double fastest = 0;
    for (Eigen::Index j = 0; j < lower.size(); ++j) {
      const double mean = (trajectory.positions[i + 1][j] - trajectory.positions[i][j]) / h;
      fastest = std::max(
          fastest, detail::cubic_peak_speed(mean, trajectory.velocities[i][j], trajectory.velocities[i + 1][j], h));
    }
    const auto count = static_cast<std::int64_t>(std::clamp(std::ceil(fastest * h / step), 1.0, 1e15));
    for (std::int64_t k = 1; k <= count; ++k) {
      detail::end_if_stopped(monitor.stop);
      const double t = trajectory.times[i] + h * static_cast<double>(k) / static_cast<double>(count);
      const Eigen::VectorXd q = trajectory.at(t);
      if (free(q)) continue;
      blocked.push_back(q);
      break;
    }
  }
  return blocked;
}

/// Halves the deviation of each corner next to a blocked configuration. False when none of them can come closer. Throws
/// TimingStopped.
bool tighten(const TimedPath& timed, const Waypoints& blocked, std::vector<double>& deviations,
             const CancelToken& stop) {
  std::vector<bool> touched(deviations.size(), false);
  bool changed = false;
  for (const auto& q : blocked) {
    if (deviations.empty()) return false;
    detail::end_if_stopped(stop);
    const std::size_t corner = timed.nearest_corner(q);
    if (touched[corner] || deviations[corner] == 0) continue;
    touched[corner] = changed = true;
    deviations[corner] /= 2;
    if (deviations[corner] < kSmallestDeviation) deviations[corner] = 0;
  }
  return changed;
}

/// Empty when the straight edges are not free. Throws TimingStopped.
JointTrajectory free_trajectory(CollisionChecker& checker, const TimedPath& timed, double max_deviation,
                                double joint_step, const Monitor& monitor) {
  std::vector<double> deviations(timed.corner_count(), max_deviation);
  for (;;) {
    JointTrajectory trajectory = timed.trajectory(deviations);
    const Waypoints blocked = blocked_configurations(checker, trajectory, joint_step, monitor);
    trajectory.names = checker.group().names();
    if (blocked.empty()) return trajectory;
    if (!tighten(timed, blocked, deviations, monitor.stop)) return {};
  }
}

}  // namespace

void TimingOptions::check() const {
  require_not_negative(max_deviation, "max_deviation");
  require_within(sample_period, 1e-9, kLargestNumber, "sample_period", "s");
  if (jerk_limits.size() > 0) check_limits(jerk_limits, jerk_limits.size(), "jerk_limits");
}

JointTrajectory time_parameterize(const JointPath& path, const Eigen::VectorXd& velocity_limits,
                                  const Eigen::VectorXd& acceleration_limits, const TimingOptions& options,
                                  const std::vector<std::string>& names, const Monitor& monitor) {
  options.check();
  check_path(path);
  const Eigen::Index size = path.waypoints.front().size();
  check_limits(velocity_limits, size, "velocity_limits");
  check_limits(acceleration_limits, size, "acceleration_limits");
  if (options.jerk_limits.size() > 0) check_limits(options.jerk_limits, size, "jerk_limits");
  require(names.empty() || static_cast<Eigen::Index>(names.size()) == size, "names", static_cast<double>(names.size()),
          "must be empty or have one entry per joint (" + std::to_string(size) + ")");
  const TimedPath timed(without_repeats(path.waypoints), velocity_limits, acceleration_limits, options, monitor);
  try {
    JointTrajectory trajectory = timed.trajectory(std::vector<double>(timed.corner_count(), options.max_deviation));
    trajectory.names = names;
    for (Eigen::Index i = 0; names.empty() && i < size; ++i)
      trajectory.names.push_back("joint_" + std::to_string(i + 1));
    return trajectory;
  } catch (const detail::TimingStopped&) {
    return {};
  }
}

JointTrajectory time_parameterize_free(CollisionChecker& checker, const JointPath& path, const TimingOptions& options,
                                       double joint_step, const Monitor& monitor) {
  options.check();
  check_path(path);
  require_within(joint_step, 1e-9, kLargestLength, "joint_step", "rad or m");
  const JointGroup& group = checker.group();
  group.check_configuration(path.waypoints.front(), "path.waypoints[0]");
  check_limits(group.velocity_limits(), group.size(), "velocity_limits");
  check_limits(group.acceleration_limits(), group.size(), "acceleration_limits");
  if (options.jerk_limits.size() > 0) check_limits(options.jerk_limits, group.size(), "jerk_limits");
  const TimedPath timed(without_repeats(path.waypoints), group.velocity_limits(), group.acceleration_limits(), options,
                        monitor);
  try {
    return free_trajectory(checker, timed, options.max_deviation, joint_step, monitor);
  } catch (const detail::TimingStopped&) {
    return {};
  }
}

}  // namespace mmgrasp
