#include "plan/timing/path_timing.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "plan/timing/timing_stop.hpp"

namespace mmgrasp::detail {
namespace {

constexpr int kGridIntervals = 600;  // Along the whole path, about.
constexpr int kIntervalsPerLine = 24;
constexpr int kIntervalsPerArc = 16;
constexpr double kZeroDerivative = 1e-12;  // Smaller path derivatives count as zero.

}  // namespace

/// The set of (x, u) of one interval: max(lower) <= u <= min(upper), lines in x, and 0 <= x <= largest. It is convex
/// and contains (0, 0).
struct PathTiming::Bounds {
  struct Line {
    double at_zero = 0, slope = 0;
    double at(double x) const { return at_zero + slope * x; }
  };
  std::vector<Line> lower, upper;
  double largest = kInfinity;

  /// |a u + b x| <= limit.
  void add(double a, double b, double limit) {
    if (std::abs(a) < kZeroDerivative) {
      if (std::abs(b) > kZeroDerivative) largest = std::min(largest, limit / std::abs(b));
      return;
    }
    lower.push_back({-limit / std::abs(a), -b / a});
    upper.push_back({limit / std::abs(a), -b / a});
  }

  const Line& highest_lower(double x) const {
    return *std::max_element(lower.begin(), lower.end(),
                             [x](const Line& l, const Line& r) { return l.at(x) < r.at(x); });
  }
  const Line& lowest_upper(double x) const {
    return *std::min_element(upper.begin(), upper.end(),
                             [x](const Line& l, const Line& r) { return l.at(x) < r.at(x); });
  }

  /// Largest x with some u: from above, to where the two lines that exclude x cross, until none do.
  double largest_x() const {
    double x = largest;
    for (std::size_t k = 0; k < lower.size() + upper.size(); ++k) {
      const Line& low = highest_lower(x);
      const Line& high = lowest_upper(x);
      if (low.at(x) <= high.at(x)) return x;
      const double crossing = (high.at_zero - low.at_zero) / (low.slope - high.slope);
      if (!(crossing < x)) return x;  // Rounding: they cross here.
      x = std::max(0.0, crossing);
    }
    return x;
  }
};

PathTiming::PathTiming(const BlendedPath& path, const Eigen::VectorXd& velocity_limits,
                       const Eigen::VectorXd& acceleration_limits, const CancelToken& stop)
    : path_(path), velocity_limits_(velocity_limits), acceleration_limits_(acceleration_limits), stop_(stop) {
  make_grid();
  integrate();
}

void PathTiming::make_grid() {
  const double spacing = path_.length() / kGridIntervals;
  const auto& segments = path_.segments();
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const int least = segments[i].radius == 0 ? kIntervalsPerLine : kIntervalsPerArc;
    const int count = std::max(least, static_cast<int>(std::ceil(segments[i].length / spacing)));
    for (int k = 0; k < count; ++k) {
      intervals_.push_back({i, segments[i].length * k / count, segments[i].length * (k + 1) / count});
    }
  }
  speed_limits_.assign(intervals_.size() + 1, kInfinity);
  for (std::size_t k = 0; k < intervals_.size(); ++k) {
    end_if_stopped(stop_);
    const Interval& interval = intervals_[k];
    const auto& segment = segments[interval.segment];
    for (const bool end : {false, true}) {
      const Eigen::VectorXd slope = segment.derivative(end ? interval.s1 : interval.s0);
      double& limit = speed_limits_[k + end];
      for (Eigen::Index i = 0; i < slope.size(); ++i) {
        const double speed = velocity_limits_[i] / std::max(std::abs(slope[i]), kZeroDerivative);
        limit = std::min(limit, speed * speed);
      }
    }
    if (k == 0 || (interval.s0 == 0 && segment.stop_before)) speed_limits_[k] = 0;
  }
  speed_limits_.back() = 0;
}

PathTiming::Bounds PathTiming::bounds(std::size_t k, double next_limit) const {
  const Interval& interval = intervals_[k];
  const auto& segment = path_.segments()[interval.segment];
  const double two_step = 2 * (interval.s1 - interval.s0);
  const Eigen::VectorXd slope0 = segment.derivative(interval.s0), slope1 = segment.derivative(interval.s1);
  const Eigen::VectorXd bend0 = segment.second_derivative(interval.s0), bend1 = segment.second_derivative(interval.s1);
  Bounds bounds;
  bounds.lower.reserve(2 * slope0.size() + 1);
  bounds.upper.reserve(2 * slope0.size() + 1);
  for (Eigen::Index i = 0; i < slope0.size(); ++i) {
    bounds.add(slope0[i], bend0[i], acceleration_limits_[i]);
    // The limit at the far end of the interval, where x has become x + 2 step u.
    if (segment.radius > 0) bounds.add(slope1[i] + bend1[i] * two_step, bend1[i], acceleration_limits_[i]);
  }
  bounds.lower.push_back({0, -1 / two_step});
  bounds.upper.push_back({next_limit / two_step, -1 / two_step});
  bounds.largest = std::min(bounds.largest, speed_limits_[k]);
  return bounds;
}

void PathTiming::integrate() {
  const std::size_t n = intervals_.size();
  std::vector<double> drivable(n + 1);  // Largest x from which the rest of the path can be driven.
  drivable[n] = 0;
  for (std::size_t k = n; k-- > 0;) {
    end_if_stopped(stop_);
    drivable[k] = bounds(k, drivable[k + 1]).largest_x();
  }
  x_.assign(n + 1, 0);
  times_.assign(n + 1, 0);
  for (std::size_t k = 0; k < n; ++k) {
    end_if_stopped(stop_);
    const double step = intervals_[k].s1 - intervals_[k].s0;
    const double u = bounds(k, drivable[k + 1]).lowest_upper(x_[k]).at(x_[k]);
    x_[k + 1] = std::clamp(x_[k] + 2 * step * u, 0.0, drivable[k + 1]);
    times_[k + 1] = times_[k] + 2 * step / (std::sqrt(x_[k]) + std::sqrt(x_[k + 1]));
  }
}

PathTiming::State PathTiming::state(std::size_t k, double time) const {
  const Interval& interval = intervals_[k];
  const auto& segment = path_.segments()[interval.segment];
  const double step = interval.s1 - interval.s0;
  const double u = (x_[k + 1] - x_[k]) / (2 * step);
  const double speed = std::max(0.0, std::sqrt(x_[k]) + u * time);
  const double s = std::clamp(interval.s0 + (std::sqrt(x_[k]) + 0.5 * u * time) * time, interval.s0, interval.s1);
  const Eigen::VectorXd slope = segment.derivative(s);
  return {segment.position(s), slope * speed, slope * u + segment.second_derivative(s) * speed * speed,
          segment.start + s};
}

PathTiming::State PathTiming::at(double time) const {
  const auto after = std::upper_bound(times_.begin(), times_.end(), time);
  const auto k =
      std::clamp<std::ptrdiff_t>(after - times_.begin() - 1, 0, static_cast<std::ptrdiff_t>(intervals_.size()) - 1);
  return state(k, std::clamp(time, times_[k], times_[k + 1]) - times_[k]);
}

std::vector<double> PathTiming::jumps(double relative) const {
  std::vector<double> result;
  for (std::size_t k = 1; k < intervals_.size(); ++k) {
    end_if_stopped(stop_);
    const Eigen::VectorXd before = state(k - 1, times_[k] - times_[k - 1]).acceleration;
    const Eigen::VectorXd after = state(k, 0).acceleration;
    const double jump = ((after - before).cwiseAbs().cwiseQuotient(acceleration_limits_)).maxCoeff();
    if (jump > relative) result.push_back(times_[k]);
  }
  return result;
}

}  // namespace mmgrasp::detail
