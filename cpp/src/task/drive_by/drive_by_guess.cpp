#include "task/drive_by/drive_by_guess.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/robot/base_motion.hpp"
#include "task/drive_by/drive_by_goals.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int kLeastIntervals = 3;
constexpr double kRamp = 0.25;  // share of a segment in which it speeds up from rest

/// Share of the way after share u of the time, resting at the given ends.
double eased(double u, bool rest_first, bool rest_last) {
  const double first = rest_first ? kRamp : 0, last = rest_last ? kRamp : 0;
  const double cruise = 1 / (1 - 0.5 * first - 0.5 * last);
  if (u < first) return 0.5 * cruise * u * u / first;
  if (u > 1 - last) return 1 - 0.5 * cruise * (1 - u) * (1 - u) / last;
  return cruise * (u - 0.5 * first);
}

/// A way of the base between two poses, by share of it.
class BaseWay {
 public:
  BaseWay(const Vector3d& from, const Vector3d& to, BaseKind kind) : from_(from), to_(to) {
    const Vector2d way = (to - from).head<2>();
    const double along = way.norm() > 1e-6 ? std::atan2(way.y(), way.x()) : from[2];
    first_ = wrap_angle(along - from[2]);
    last_ = wrap_angle(along - to[2]);
    straight_ = kind != BaseKind::diff_drive || way.norm() < 0.05;
    backwards_ = std::abs(first_) > kPi / 2 && std::abs(last_) > kPi / 2;
    curve_ = !straight_ && (backwards_ || (std::abs(first_) < 1.4 && std::abs(last_) < 1.4));
  }

  Vector3d at(double s) const {
    if (straight_) return from_ + s * (to_ - from_);
    if (curve_) return on_curve(s);
    return turn_drive_turn(s);
  }

 private:
  Vector3d on_curve(double s) const {
    const double length = (to_ - from_).head<2>().norm() * (backwards_ ? -1 : 1);
    const Vector2d a = length * Vector2d(std::cos(from_[2]), std::sin(from_[2]));
    const Vector2d b = length * Vector2d(std::cos(to_[2]), std::sin(to_[2]));
    const double s2 = s * s, s3 = s2 * s;
    const Vector2d p = (2 * s3 - 3 * s2 + 1) * from_.head<2>() + (s3 - 2 * s2 + s) * a +
                       (-2 * s3 + 3 * s2) * to_.head<2>() + (s3 - s2) * b;
    Vector2d d = (6 * s2 - 6 * s) * (from_ - to_).head<2>() + (3 * s2 - 4 * s + 1) * a + (3 * s2 - 2 * s) * b;
    if (backwards_) d = -d;
    const double middle = from_[2] + s * (to_[2] - from_[2]);
    const double heading = d.norm() > 1e-9 ? middle + wrap_angle(std::atan2(d.y(), d.x()) - middle) : middle;
    return {p.x(), p.y(), heading};
  }
  Vector3d turn_drive_turn(double s) const {
    constexpr double kTurn = 0.25;
    const double along = from_[2] + first_;
    if (s < kTurn) return {from_[0], from_[1], from_[2] + first_ * s / kTurn};
    if (s > 1 - kTurn) return {to_[0], to_[1], along + (to_[2] - along) * (s - 1 + kTurn) / kTurn};
    const double u = (s - kTurn) / (1 - 2 * kTurn);
    return {from_[0] + u * (to_[0] - from_[0]), from_[1] + u * (to_[1] - from_[1]), along};
  }

  Vector3d from_, to_;
  double first_ = 0, last_ = 0;
  bool straight_ = false, backwards_ = false, curve_ = false;
};

}  // namespace

VectorXd GuidedWay::at(double time) const {
  const auto after = std::upper_bound(times.begin(), times.end(), time);
  if (after == times.end()) return points.back();
  const std::size_t i = std::max<std::ptrdiff_t>(1, after - times.begin());
  const double share = (time - times[i - 1]) / (times[i] - times[i - 1]);
  return points[i - 1] + share * (points[i] - points[i - 1]);
}

std::vector<double> segment_times(const JointGroup& group, const std::vector<VectorXd>& via_points) {
  std::vector<double> times;
  for (std::size_t i = 0; i + 1 < via_points.size(); ++i) {
    double time = travel_time(group, via_points[i], via_points[i + 1]);
    const bool rests = i == 0 || i + 2 == via_points.size();
    if (rests && group.has_base()) {
      const BaseLimits& limits = group.robot().base_limits();
      time += 0.5 * limits.linear_velocity / limits.linear_acceleration;
    }
    times.push_back(std::max(0.5, 1.1 * time));
  }
  return times;
}

std::vector<int> share_intervals(int intervals, const std::vector<double>& times) {
  const int segments = static_cast<int>(times.size());
  const int least = std::min(kLeastIntervals, intervals / segments);
  const double sum = std::accumulate(times.begin(), times.end(), 0.0);
  std::vector<int> shares;
  int left = intervals - least * segments;
  const int spare = left;
  for (double time : times) {
    const int extra = std::min(left, static_cast<int>(std::floor(spare * time / sum)));
    shares.push_back(least + extra);
    left -= extra;
  }
  for (std::size_t i = 0; left > 0; i = (i + 1) % shares.size(), --left) ++shares[i];
  return shares;
}

WholeBodyGuess guess_through(const JointGroup& group, const std::vector<VectorXd>& via_points,
                             const std::vector<int>& intervals, const std::vector<double>& times,
                             const std::vector<GuidedWay>& ways) {
  WholeBodyGuess guess;
  for (std::size_t k = 0; k + 1 < via_points.size(); ++k) {
    const VectorXd &from = via_points[k], &to = via_points[k + 1];
    const int n = intervals[k];
    for (int i = 0; i < n; ++i) {
      const double s = eased(static_cast<double>(i) / n, k == 0, k + 2 == via_points.size());
      VectorXd q = from + s * (to - from);
      if (!ways.empty() && !ways[k].points.empty()) {
        guess.positions.push_back(ways[k].at(s * ways[k].times.back()));
        continue;
      }
      if (group.has_base()) q.head<3>() = BaseWay(from.head<3>(), to.head<3>(), group.robot().base()).at(s);
      guess.positions.push_back(q);
    }
    guess.steps.push_back(times[k] / n);
  }
  guess.positions.push_back(via_points.back());
  return guess;
}

WholeBodyGuess resampled(const WholeBodyTrajectory& trajectory, const std::vector<double>& segment_ends,
                         const std::vector<int>& intervals) {
  WholeBodyGuess guess;
  double from = 0;
  for (std::size_t k = 0; k < intervals.size(); ++k) {
    const double step = (segment_ends[k] - from) / intervals[k];
    for (int i = 0; i < intervals[k]; ++i) {
      guess.positions.push_back(trajectory.at(from + i * step));
      guess.drive.push_back(trajectory.drive_at(from + i * step));
    }
    guess.steps.push_back(step);
    from = segment_ends[k];
  }
  guess.positions.push_back(trajectory.positions().back());
  guess.drive.push_back(trajectory.drive().back());
  return guess;
}

}  // namespace mmgrasp::detail
