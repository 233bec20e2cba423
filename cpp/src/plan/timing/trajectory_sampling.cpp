#include "plan/timing/trajectory_sampling.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>
#include <vector>

#include "mmgrasp/core/error.hpp"
#include "plan/timing/timing_stop.hpp"

namespace mmgrasp::detail {
namespace {

constexpr double kJump = 0.004;          // Acceleration jumps above this part of a limit get a sample of their own.
constexpr double kSmallestGap = 1e-5;    // Least time between samples at jumps [s].
constexpr double kSmallestSplit = 2e-4;  // Shorter intervals are not halved [s].
// Part of a limit by which a sample's acceleration may differ from those of the cubics before and after it.
constexpr double kCubicFit = 5e-4;
// Part of a limit by which the mean acceleration between two samples may lie beyond the accelerations at both.
constexpr double kMaxMeanBeyondEnds = 0.5;

using State = PathTiming::State;

std::pair<double, double> cubic_end_accelerations(double mean, double v0, double v1, double h) {
  return {(6 * mean - 4 * v0 - 2 * v1) / h, (2 * v0 + 4 * v1 - 6 * mean) / h};
}

/// Largest |velocity| and |acceleration| over limits of a cubic between two samples.
struct Load {
  double velocity = 0, acceleration = 0;
};

struct Sample {
  double time;
  State state;
};

/// Samples a timed path so densely that cubics between the samples keep the limits, too.
class Sampler {
 public:
  Sampler(const PathTiming& timing, const Eigen::VectorXd& velocity_limits, const Eigen::VectorXd& acceleration_limits)
      : timing_(timing), velocity_limits_(velocity_limits), acceleration_limits_(acceleration_limits) {}

  JointTrajectory run(double period) {
    if (timing_.duration() / period > kMaxSamples) refuse(period);
    samples_.push_back({0, timing_.at(0)});
    for (double end : break_times()) {
      const double begin = samples_.back().time;
      const int count = std::max(1, static_cast<int>(std::ceil((end - begin) / period - 1e-9)));
      for (int i = 1; i <= count; ++i) append(i == count ? end : begin + (end - begin) * i / count);
    }
    return slowed_down();
  }

 private:
  [[noreturn]] void refuse(double period) const {
    const auto [joint, way] = slowest_joint();
    std::ostringstream message;
    message << "sample_period = " << period << ": must leave at most 1e7 samples: the motion takes "
            << timing_.duration() << " s, mostly for joint " << joint << ", which moves by " << way
            << " with velocity_limits[" << joint << "] = " << velocity_limits_[joint] << " and acceleration_limits["
            << joint << "] = " << acceleration_limits_[joint];
    throw InvalidInput(message.str());
  }

  /// The joint whose way takes the longest at its own limits, and how far it moves.
  std::pair<Eigen::Index, double> slowest_joint() const {
    constexpr int kPieces = 100;
    Eigen::VectorXd way = Eigen::VectorXd::Zero(velocity_limits_.size()), last = timing_.at(0).position;
    for (int i = 1; i <= kPieces; ++i) {
      const Eigen::VectorXd next = timing_.at(timing_.duration() * i / kPieces).position;
      way += (next - last).cwiseAbs();
      last = next;
    }
    Eigen::Index slowest = 0;
    const Eigen::VectorXd times =
        way.cwiseQuotient(velocity_limits_).cwiseMax(2 * way.cwiseQuotient(acceleration_limits_).cwiseSqrt());
    times.maxCoeff(&slowest);
    return {slowest, way[slowest]};
  }

  /// Jump times and the end, none closer together than cubics can resolve. Of jumps that are, the last one stays: a
  /// sample's acceleration is that of what follows, and what lies between the jumps (a straight of a micrometre between
  /// two arcs) would stand for a whole interval.
  std::vector<double> break_times() const {
    std::vector<double> times;
    for (double t : timing_.jumps(kJump)) {
      if (t < kSmallestGap || timing_.duration() - t < kSmallestGap) continue;
      if (!times.empty() && t - times.back() < kSmallestGap) times.pop_back();
      times.push_back(t);
    }
    times.push_back(timing_.duration());
    return times;
  }

  /// Where the acceleration swings away and back within an interval, the ends do not tell: their velocities differ by
  /// what neither acceleration accounts for.
  bool hides_acceleration(const Sample& a, const Sample& b) const {
    for (Eigen::Index j = 0; j < acceleration_limits_.size(); ++j) {
      const double mean = (b.state.velocity[j] - a.state.velocity[j]) / (b.time - a.time);
      const double first = a.state.acceleration[j], second = b.state.acceleration[j];
      const double beyond = std::max(mean - std::max(first, second), std::min(first, second) - mean);
      if (beyond > kMaxMeanBeyondEnds * acceleration_limits_[j]) return true;
    }
    return false;
  }

  /// Where the acceleration bends within an interval, the cubic that is executed begins with another one than the
  /// sample says. Where it has jumped at the sample, or jumps in the interval, the cubic on one side still says what
  /// the sample does.
  bool differs_from_cubics(const Sample& a, const Sample& b) const {
    const Sample* before = samples_.size() > 1 ? &samples_[samples_.size() - 2] : nullptr;
    for (Eigen::Index j = 0; j < acceleration_limits_.size(); ++j) {
      const double said = a.state.acceleration[j], most = kCubicFit * acceleration_limits_[j];
      if (std::abs(said - ends(a, b, j).first) <= most) continue;
      if (before == nullptr || std::abs(said - ends(*before, a, j).second) > most) return true;
    }
    return false;
  }

  static std::pair<double, double> ends(const Sample& a, const Sample& b, Eigen::Index j) {
    const double h = b.time - a.time, mean = (b.state.position[j] - a.state.position[j]) / h;
    return cubic_end_accelerations(mean, a.state.velocity[j], b.state.velocity[j], h);
  }

  /// Appends the sample at `time`, after those that keep the cubics in between within limits.
  void append(double time) { append({time, timing_.at(time)}); }
  void append(Sample sample) {
    end_if_stopped(timing_.stop());
    const Sample& previous = samples_.back();
    const double interval = sample.time - previous.time;
    const Load load = hermite_load(previous, sample);
    const bool beyond = std::max(load.velocity, load.acceleration) > 1;
    const bool unlike = hides_acceleration(previous, sample) || differs_from_cubics(previous, sample);
    if ((beyond || unlike) && interval > kSmallestSplit) {
      append(previous.time + 0.5 * interval);
      append(std::move(sample));
      return;
    }
    worst_.velocity = std::max(worst_.velocity, load.velocity);
    worst_.acceleration = std::max(worst_.acceleration, load.acceleration);
    samples_.push_back(std::move(sample));
  }

  Load hermite_load(const Sample& a, const Sample& b) const {
    const double h = b.time - a.time;
    Load load;
    for (Eigen::Index i = 0; i < velocity_limits_.size(); ++i) {
      const double mean = (b.state.position[i] - a.state.position[i]) / h;
      const double v0 = a.state.velocity[i], v1 = b.state.velocity[i];
      const auto [a0, a1] = cubic_end_accelerations(mean, v0, v1, h);
      const double fastest = cubic_peak_speed(mean, v0, v1, h);
      // The cubic's acceleration is linear: its extremes are at the ends.
      const double hardest =
          std::max({std::abs(a0), std::abs(a1), std::abs(a.state.acceleration[i]), std::abs(b.state.acceleration[i])});
      load.velocity = std::max(load.velocity, fastest / velocity_limits_[i]);
      load.acceleration = std::max(load.acceleration, hardest / acceleration_limits_[i]);
    }
    return load;
  }

  JointTrajectory slowed_down() const {
    const double factor = std::max({1.0, worst_.velocity, std::sqrt(worst_.acceleration)});
    JointTrajectory trajectory;
    for (const Sample& sample : samples_) {
      end_if_stopped(timing_.stop());
      trajectory.times.push_back(sample.time * factor);
      trajectory.positions.push_back(sample.state.position);
      trajectory.velocities.push_back(sample.state.velocity / factor);
      trajectory.accelerations.push_back(sample.state.acceleration / (factor * factor));
    }
    return trajectory;
  }

  const PathTiming& timing_;
  const Eigen::VectorXd& velocity_limits_;
  const Eigen::VectorXd& acceleration_limits_;
  std::vector<Sample> samples_;
  Load worst_;
};

}  // namespace

double cubic_peak_speed(double mean, double v0, double v1, double h) {
  const auto [a0, a1] = cubic_end_accelerations(mean, v0, v1, h);
  const double at_ends = std::max(std::abs(v0), std::abs(v1));
  // Where the acceleration changes sign, at h a0 / (a0 - a1), the speed has its extreme.
  return a0 * a1 < 0 ? std::max(at_ends, std::abs(v0 + 0.5 * a0 * h * a0 / (a0 - a1))) : at_ends;
}

JointTrajectory sample_trajectory(const PathTiming& timing, const Eigen::VectorXd& velocity_limits,
                                  const Eigen::VectorXd& acceleration_limits, double period) {
  return Sampler(timing, velocity_limits, acceleration_limits).run(period);
}

}  // namespace mmgrasp::detail
