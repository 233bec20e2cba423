// Drives on a clock: every piece of a BasePath from rest to rest with a trapezoidal profile.
#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/robot/base_motion.hpp"
#include "mmgrasp/task/base_route.hpp"

namespace mmgrasp {
namespace {

constexpr double kMostSamples = 1e7;  // One drive has no more.

/// The share of a straight piece that is driven, from 0 to 1: as fast as both way and turn allow, and the wheels of a
/// base that does both at once.
class Profile {
 public:
  Profile(const Eigen::Vector3d& from, const Eigen::Vector3d& to, BaseKind base, const BaseLimits& limits) {
    const Eigen::Vector3d way = to - from;
    const double driven = way.head<2>().norm(), turned = std::abs(way.z());
    if (driven == 0 && turned == 0) return;
    const auto share = [](double limit, double size) { return size > 0 ? limit / size : detail::kInfinity; };
    acceleration_ = std::min(share(limits.linear_acceleration, driven), share(limits.angular_acceleration, turned));
    double top = std::min(share(limits.linear_velocity, driven), share(limits.angular_velocity, turned));
    if (base == BaseKind::omni)
      top = std::min(top, share(limits.wheel_velocity, largest_rim_travel(wheel_rows(base, limits), from.z(), way)));
    const bool triangle = acceleration_ <= top * top;
    ramp_ = triangle ? std::sqrt(1 / acceleration_) : top / acceleration_;
    duration_ = triangle ? 2 * ramp_ : 1 / top + ramp_;
  }
  double duration() const { return duration_; }
  double ramp() const { return ramp_; }
  double rate(double t) const { return acceleration_ * std::min({t, ramp_, duration_ - t}); }
  double at(double t) const {
    const double top = acceleration_ * ramp_;
    if (t <= ramp_) return 0.5 * acceleration_ * t * t;
    const double left = duration_ - t;
    return left >= ramp_ ? top * (t - 0.5 * ramp_) : 1 - 0.5 * acceleration_ * left * left;
  }

 private:
  double acceleration_ = 0, ramp_ = 0, duration_ = 0;
};

}  // namespace

double base_path_duration(const BasePath& path, BaseKind base, const BaseLimits& base_limits) {
  const BaseLimits limits = driving_limits(base, base_limits);
  double duration = 0;
  for (std::size_t i = 1; i < path.poses.size(); ++i)
    duration += Profile(path.poses[i - 1], path.poses[i], base, limits).duration();
  return duration;
}

RobotMotion base_path_motion(const BasePath& path, BaseKind base, const BaseLimits& base_limits,
                             const std::vector<std::string>& joints, const Eigen::VectorXd& q, double period) {
  require_within(period, 1e-4, 1e6, "period", "s");
  if (path.poses.empty()) throw InvalidInput("path: has no poses");
  require(q.size() == static_cast<Eigen::Index>(joints.size()), "q", static_cast<double>(q.size()),
          "must hold one value per joint");
  const BaseLimits limits = driving_limits(base, base_limits);
  require(base_path_duration(path, base, base_limits) / period <= kMostSamples, "period", period,
          "must leave at most 1e7 samples of the drive [s]");
  RobotMotion motion;
  motion.joints = joints;
  const auto add = [&](double time, const Eigen::Vector3d& pose, const Eigen::Vector3d& velocity) {
    motion.times.push_back(time);
    motion.base_poses.push_back(pose);
    motion.base_twists.push_back(platform_velocity(pose.z(), velocity));
  };
  add(0, path.poses[0], Eigen::Vector3d::Zero());
  for (std::size_t i = 1; i < path.poses.size(); ++i) {
    const Eigen::Vector3d from = path.poses[i - 1], way = path.poses[i] - from;
    const Profile profile(from, path.poses[i], base, limits);
    const double begin = motion.duration(), T = profile.duration();
    double before = 0;
    for (const double until : {profile.ramp(), T - profile.ramp(), T}) {
      if (until - before <= 1e-9 * (1 + T) && until < T) continue;  // no stretch at full speed
      const int pieces = std::max(1, static_cast<int>(std::ceil((until - before) / period - 1e-9)));
      for (int k = 1; k <= pieces && T > 0; ++k) {
        const double t = k == pieces ? until : before + (until - before) * k / pieces;
        add(begin + t, t == T ? path.poses[i] : Eigen::Vector3d(from + profile.at(t) * way), profile.rate(t) * way);
      }
      before = until;
    }
  }
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(q.size());
  motion.positions.assign(motion.times.size(), q);
  motion.velocities.assign(motion.times.size(), rest);
  motion.accelerations.assign(motion.times.size(), rest);
  return motion;
}

}  // namespace mmgrasp
