#include "plan/timing/jerk_limit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "mmgrasp/core/error.hpp"
#include "plan/timing/timing_stop.hpp"
#include "plan/timing/trajectory_sampling.hpp"

namespace mmgrasp::detail {
namespace {

constexpr int kBisections = 24;
constexpr double kStopped = 1e-9;     // Slower than this counts as a stop [rad/s].
constexpr int kSamplesPerWindow = 8;  // The average changes over a window's time.
// A shorter ramp of the acceleration counts as a jump: third differences of samples so close are rounding [s].
constexpr double kShortestWindow = 1e-4;

/// A motion as cubics between samples, standing still before and after, with its integral.
class Cubics {
 public:
  /// Throws TimingStopped.
  Cubics(JointTrajectory motion, const CancelToken& stop)
      : times_(std::move(motion.times)),
        positions_(std::move(motion.positions)),
        velocities_(std::move(motion.velocities)) {
    const Eigen::VectorXd origin = positions_.front();
    for (auto& p : positions_) p -= origin;  // Sums of small numbers round less.
    integrals_.push_back(Eigen::VectorXd::Zero(origin.size()));
    for (std::size_t i = 0; i + 1 < times_.size(); ++i) {
      end_if_stopped(stop);
      const double h = times_[i + 1] - times_[i];
      integrals_.push_back(integrals_.back() + 0.5 * h * (positions_[i] + positions_[i + 1]) +
                           h * h / 12 * (velocities_[i] - velocities_[i + 1]));
    }
  }

  const std::vector<double>& times() const { return times_; }
  double duration() const { return times_.back(); }
  /// Ends of the waits of `wait` seconds: there the average over as long a window stands at the corner.
  std::vector<double> ends_of_waits(double wait) const {
    std::vector<double> ends;
    for (std::size_t i = 0; i + 1 < times_.size(); ++i) {
      if (times_[i + 1] - times_[i] > 0.5 * wait && positions_[i + 1] == positions_[i]) ends.push_back(times_[i + 1]);
    }
    return ends;
  }

  /// The integral of the position (from the first one) up to `t`.
  Eigen::VectorXd integral(double t) const {
    if (t <= 0) return Eigen::VectorXd::Zero(integrals_.front().size());
    if (t >= duration()) return integrals_.back() + (t - duration()) * positions_.back();
    const Piece p = piece(t);
    return integrals_[p.i] + p.h * (p.s * positions_[p.i] +
                                    p.s * p.s * (0.5 * p.h * velocities_[p.i] + p.s * (p.c2 / 3 + p.s * p.c3 / 4)));
  }
  /// The mean position over a time of a few samples: unlike the difference of two integrals, precise at any length.
  Eigen::VectorXd mean(double from, double to) const {
    const Eigen::VectorXd origin = position(from);
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(origin.size()), begin = sum;
    double t = from;
    auto next = std::upper_bound(times_.begin(), times_.end(), from);
    while (t < to) {
      const double end = next == times_.end() ? to : std::min(*next++, to);
      const Eigen::VectorXd middle = position(0.5 * (t + end)) - origin, last = position(end) - origin;
      sum += (end - t) / 6 * (begin + 4 * middle + last);  // Simpson's rule is exact for cubics.
      begin = last;
      t = end;
    }
    return origin + sum / (to - from);
  }
  Eigen::VectorXd position(double t) const {
    if (t <= 0) return positions_.front();
    if (t >= duration()) return positions_.back();
    const Piece p = piece(t);
    return positions_[p.i] + p.s * (p.h * velocities_[p.i] + p.s * (p.c2 + p.s * p.c3));
  }
  Eigen::VectorXd velocity(double t) const {
    if (t <= 0 || t >= duration()) return Eigen::VectorXd::Zero(positions_.front().size());
    const Piece p = piece(t);
    return velocities_[p.i] + p.s / p.h * (2 * p.c2 + 3 * p.s * p.c3);
  }

 private:
  struct Piece {
    std::size_t i;
    double h, s;
    Eigen::VectorXd c2, c3;
  };
  Piece piece(double t) const {
    const auto next = std::upper_bound(times_.begin(), times_.end(), t);
    Piece p;
    p.i = std::clamp<std::ptrdiff_t>(next - times_.begin() - 1, 0, static_cast<std::ptrdiff_t>(times_.size()) - 2);
    p.h = times_[p.i + 1] - times_[p.i];
    p.s = (t - times_[p.i]) / p.h;
    const Eigen::VectorXd delta = positions_[p.i + 1] - positions_[p.i];
    p.c2 = 3 * delta - p.h * (2 * velocities_[p.i] + velocities_[p.i + 1]);
    p.c3 = p.h * (velocities_[p.i] + velocities_[p.i + 1]) - 2 * delta;
    return p;
  }

  std::vector<double> times_;
  std::vector<Eigen::VectorXd> positions_, velocities_, integrals_;
};

bool is_inner_stop(const JointTrajectory& motion, std::size_t i) {
  return i > 0 && i + 1 < motion.times.size() && motion.velocities[i].lpNorm<Eigen::Infinity>() <= kStopped;
}

/// The motion with a wait of `wait` seconds at each inner stop.
JointTrajectory with_waits(const JointTrajectory& motion, double wait, const CancelToken& stop) {
  JointTrajectory out;
  double late = 0;
  for (std::size_t i = 0; i < motion.times.size(); ++i) {
    end_if_stopped(stop);
    const auto add = [&] {
      out.times.push_back(motion.times[i] + late);
      out.positions.push_back(motion.positions[i]);
      out.velocities.push_back(motion.velocities[i]);
    };
    add();
    if (!is_inner_stop(motion, i)) continue;
    late += wait;
    add();
  }
  return out;
}

/// What bisection asks of a motion: accelerations alone, with waits at inner stops that become longer or shorter.
class Accelerations {
 public:
  /// Throws TimingStopped.
  Accelerations(const JointTrajectory& motion, const CancelToken& stop) {
    const Eigen::Index joints = motion.positions.front().size();
    const auto stops = static_cast<std::ptrdiff_t>(motion.times.size());
    begin_.setZero(joints, 2 * stops);
    slope_.setZero(joints, 2 * stops);
    for (std::size_t i = 0; i + 1 < motion.times.size(); ++i) {
      end_if_stopped(stop);
      if (is_inner_stop(motion, i)) lengths_.push_back(kWait);
      const double h = motion.times[i + 1] - motion.times[i];
      const Eigen::VectorXd mean = (motion.positions[i + 1] - motion.positions[i]) / h;
      const auto piece = static_cast<Eigen::Index>(lengths_.size());
      begin_.col(piece) = (6 * mean - 4 * motion.velocities[i] - 2 * motion.velocities[i + 1]) / h;
      slope_.col(piece) = 6 * (motion.velocities[i] + motion.velocities[i + 1] - 2 * mean) / (h * h);
      lengths_.push_back(h);
    }
    times_.resize(lengths_.size() + 1);
  }

  /// Whether the average over `window` keeps the jerk limits, with waits as long as it: its jerk is linear between the
  /// times at which either end of the window meets a sample, so that checking both sides of these is enough.
  bool keep_jerk(double window, const Eigen::VectorXd& jerk_limits, const CancelToken& stop) {
    times_.front() = 0;
    for (std::size_t i = 0; i < lengths_.size(); ++i)
      times_[i + 1] = times_[i] + (lengths_[i] == kWait ? window : lengths_[i]);
    const double side = std::min(1e-9 * (times_.back() + window), 1e-3 * window);
    const Eigen::ArrayXd bound = window * jerk_limits.array() * (1 + 1e-9);
    Eigen::ArrayXd here(bound.size()), there(bound.size());
    std::size_t near_piece = 0, earlier_piece = 0, later_piece = 0;
    for (const double t : times_) {
      end_if_stopped(stop);
      for (const double near : {t - side, t + side}) {
        at(near, near_piece, here);
        at(near - window, earlier_piece, there);
        if (((here - there).abs() > bound).any()) return false;
        at(near + window, later_piece, there);
        if (((here - there).abs() > bound).any()) return false;
      }
    }
    return true;
  }

 private:
  static constexpr double kWait = -1;  ///< The length of a piece that is a wait.

  /// The acceleration at `t`, whose piece is sought from `piece` on: that of a time close by.
  void at(double t, std::size_t& piece, Eigen::ArrayXd& out) const {
    if (t <= 0 || t >= times_.back()) {
      out.setZero();
      return;
    }
    while (times_[piece + 1] <= t) ++piece;
    while (times_[piece] > t) --piece;
    const auto i = static_cast<Eigen::Index>(piece);
    out = begin_.col(i).array() + (t - times_[piece]) * slope_.col(i).array();
  }

  Eigen::MatrixXd begin_, slope_;  ///< A column for each piece: the acceleration at its begin, and its change.
  std::vector<double> lengths_, times_;
};

/// Whether samples that are a fixed part of the window apart would be far too many.
bool is_short(double window, double period) {
  return 2 * window < period;
}

/// Times of samples from 0 to the average's end. Between the times at which an end of the window meets a sample, its
/// jerk is linear: under a short window samples crowd around these times alone. A sample at each stop keeps the cubics
/// from cutting its corner.
std::vector<double> sample_times(const Cubics& motion, double window, double period) {
  const double duration = motion.duration() + window;
  std::vector<double> events = motion.ends_of_waits(window);
  events.push_back(duration);
  if (is_short(window, period)) {
    for (const double t : motion.times()) events.insert(events.end(), {t, t + window});
    std::sort(events.begin(), events.end());
  }
  std::vector<double> times{0};
  for (const double event : events) {
    const double begin = times.back(), gap = event - begin, step = window / kSamplesPerWindow;
    if (gap < 0.5 * step) continue;
    const double parts = is_short(window, period) ? std::min<double>(gap / step, kSamplesPerWindow) : gap / step;
    const int count = static_cast<int>(std::ceil(std::max(gap / period, parts)));
    for (int i = 1; i <= count; ++i) times.push_back(i == count ? event : begin + gap * i / count);
  }
  times.back() = duration;
  return times;
}

JointTrajectory averaged(const Cubics& motion, const Eigen::VectorXd& origin, double window, double period,
                         const CancelToken& stop) {
  JointTrajectory out;
  const bool precise = is_short(window, period);
  for (const double t : sample_times(motion, window, period)) {
    end_if_stopped(stop);
    // The window that begins at the motion's start is the average's end of rest.
    const double from = t - window;
    out.times.push_back(t);
    out.positions.push_back(origin +
                            (precise ? motion.mean(from, t) : (motion.integral(t) - motion.integral(from)) / window));
    out.velocities.push_back((motion.position(t) - motion.position(from)) / window);
    out.accelerations.push_back((motion.velocity(t) - motion.velocity(from)) / window);
  }
  return out;
}

/// Slows the motion down by what its cubics pass the limits by between samples.
void slow_down(JointTrajectory& motion, const Eigen::VectorXd& velocity_limits,
               const Eigen::VectorXd& acceleration_limits, const Eigen::VectorXd& jerk_limits) {
  double slower = 1;
  for (std::size_t i = 0; i + 1 < motion.times.size(); ++i) {
    const double h = motion.times[i + 1] - motion.times[i];
    for (Eigen::Index j = 0; j < velocity_limits.size(); ++j) {
      const double mean = (motion.positions[i + 1][j] - motion.positions[i][j]) / h;
      const double v0 = motion.velocities[i][j], v1 = motion.velocities[i + 1][j];
      const double a0 = (6 * mean - 4 * v0 - 2 * v1) / h, a1 = (2 * v0 + 4 * v1 - 6 * mean) / h;
      slower = std::max({slower, cubic_peak_speed(mean, v0, v1, h) / velocity_limits[j],
                         std::sqrt(std::max(std::abs(a0), std::abs(a1)) / acceleration_limits[j]),
                         std::cbrt(std::abs(a1 - a0) / h / jerk_limits[j])});
    }
  }
  for (std::size_t i = 0; i < motion.times.size(); ++i) {
    motion.times[i] *= slower;
    motion.velocities[i] /= slower;
    motion.accelerations[i] /= slower * slower;
  }
}

}  // namespace

JointTrajectory limit_jerk(const JointTrajectory& motion, const Eigen::VectorXd& velocity_limits,
                           const Eigen::VectorXd& acceleration_limits, const Eigen::VectorXd& jerk_limits,
                           double period, const CancelToken& stop) {
  if (motion.times.size() < 2) return motion;
  double least = kShortestWindow, enough = 2 * kShortestWindow;
  for (const auto& a : motion.accelerations)
    enough = std::max(enough, 2.1 * (a.cwiseAbs().cwiseQuotient(jerk_limits)).maxCoeff());
  Accelerations accelerations(motion, stop);
  const auto keeps = [&](double window) { return accelerations.keep_jerk(window, jerk_limits, stop); };
  if (keeps(least)) return motion;
  while (!keeps(enough)) enough *= 1.5;
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (least + enough);
    (keeps(middle) ? enough : least) = middle;
  }
  const Cubics slow(with_waits(motion, enough, stop), stop);
  const double most = (slow.duration() + enough) / std::min(period, enough / kSamplesPerWindow);
  require(is_short(enough, period) || most <= kMaxSamples, "jerk_limits", jerk_limits.minCoeff(),
          "must be so high that the motion takes at most 1e7 samples");
  JointTrajectory out = averaged(slow, motion.positions.front(), enough, period, stop);
  out.names = motion.names;
  slow_down(out, velocity_limits, acceleration_limits, jerk_limits);
  return out;
}

}  // namespace mmgrasp::detail
