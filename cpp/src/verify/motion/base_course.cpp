#include "verify/motion/base_course.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "verify/motion/stored_accelerations.hpp"

namespace mmgrasp::verify::detail {
namespace {

using Eigen::Vector3d;

constexpr double kSlack = 0.01;      // Share by which limits may be exceeded.
constexpr double kRimSlack = 2e-3;   // The same of the wheels, which no tracker can ask for more.
constexpr double kOffCourse = 1e-3;  // Largest error after the whole motion [m], [rad].
constexpr double kSideways = 1e-3;   // [m/s]

/// Velocity in the platform's frame: ahead, to the left, turning.
Vector3d platform_velocity(const Eigen::VectorXd& q, const Eigen::VectorXd& rate) {
  const double c = std::cos(q[2]), s = std::sin(q[2]);
  return {c * rate[0] + s * rate[1], -s * rate[0] + c * rate[1], rate[2]};
}

/// What drives the base, in a frame in which it changes linearly between samples: the platform's, or for an omni base
/// the world's.
Vector3d drive_of(BaseKind base, const Eigen::VectorXd& q, const Eigen::VectorXd& rate) {
  return base == BaseKind::diff_drive ? platform_velocity(q, rate) : Vector3d(rate.head<3>());
}

/// A base that follows its velocities, linear over the time h, without slipping sideways.
Vector3d driven(BaseKind base, Vector3d pose, const Vector3d& from, const Vector3d& to, double h) {
  if (base != BaseKind::diff_drive) return pose + 0.5 * h * (from + to);
  constexpr int kSteps = 16;  // Simpson's rule over each, the heading in closed form
  const double start = pose.z();
  const auto ahead = [&](double s) {
    const double theta = start + h * s * (from.z() + 0.5 * s * (to.z() - from.z()));
    const double v = from.x() + s * (to.x() - from.x());
    return Eigen::Vector2d(v * std::cos(theta), v * std::sin(theta));
  };
  for (int i = 0; i < kSteps; ++i) {
    const double a = static_cast<double>(i) / kSteps, b = static_cast<double>(i + 1) / kSteps;
    pose.head<2>() += h / kSteps / 6 * (ahead(a) + 4 * ahead(0.5 * (a + b)) + ahead(b));
  }
  pose.z() = start + 0.5 * h * (from.z() + to.z());
  return pose;
}

/// The fastest wheel's rim, of two driven wheels on one axle or of four Mecanum ones; 0 where wheels set no limit.
double rim_speed(const PlanToCheck& plan, double theta, const Vector3d& drive) {
  const BaseLimits& limits = plan.robot.base_limits;
  if (plan.robot.base == BaseKind::diff_drive)
    return std::abs(drive.x()) + 0.5 * limits.wheel_separation * std::abs(drive.z());
  if (plan.robot.base != BaseKind::omni || limits.wheelbase <= 0) return 0;
  const double c = std::cos(theta), s = std::sin(theta);
  return std::abs(c * drive.x() + s * drive.y()) + std::abs(c * drive.y() - s * drive.x()) +
         0.5 * (limits.wheel_separation + limits.wheelbase) * std::abs(drive.z());
}

struct Limit {
  const char* what;
  double limit;
  const char* code = "base-limit";
  double slack = kSlack;
  double value = 0, time = 0;

  void see(double now, double at) {
    if (std::abs(now) <= value) return;
    value = std::abs(now);
    time = at;
  }
};

void check_limits(const PlanToCheck& plan, const CheckedMotion& motion, const std::vector<Vector3d>& drive,
                  const std::string& where, Faults& faults) {
  const BaseLimits& limits = plan.robot.base_limits;
  Limit speed{"speed [m/s]", limits.linear_velocity}, turning{"turning rate [rad/s]", limits.angular_velocity};
  Limit wheel{"wheel speed [m/s]", limits.wheel_velocity, "wheel-limit", kRimSlack};
  Limit gain{"acceleration [m/s^2]", limits.linear_acceleration};
  Limit spin{"angular acceleration [rad/s^2]", limits.angular_acceleration};
  for (std::size_t i = 0; i < drive.size(); ++i) {
    const double t = motion.times[i];
    speed.see(drive[i].head<2>().norm(), t);
    turning.see(drive[i].z(), t);
    wheel.see(rim_speed(plan, motion.positions[i][2], drive[i]), t);
    if (i == 0) continue;
    const double h = motion.times[i] - motion.times[i - 1];
    for (const double share : {0.25, 0.5, 0.75}) {  // a turning base's own axes turn under its velocity
      const Vector3d between = (1 - share) * drive[i - 1] + share * drive[i];
      const double theta = motion.positions[i - 1][2] + 0.5 * h * share * (drive[i - 1] + between).z();
      wheel.see(rim_speed(plan, theta, between), t - (1 - share) * h);
    }
    gain.see((drive[i] - drive[i - 1]).head<2>().norm() / h, t);
    spin.see((drive[i] - drive[i - 1]).z() / h, t);
  }
  for (const Limit& l : {speed, turning, wheel, gain, spin}) {
    if (l.value <= (1 + l.slack) * l.limit) continue;
    faults.push_back({l.code, where + ", t = " + text(l.time) + " s",
                      std::string(l.what) + " of the base is " + text(l.value) + ", the limit " + text(l.limit)});
  }
}

/// Stored accelerations of the base are those of its velocities.
void check_accelerations(const PlanToCheck& plan, const CheckedMotion& motion, const std::string& where,
                         Faults& faults) {
  const BaseLimits& base = plan.robot.base_limits;
  // Along x and y a turning platform's acceleration has a share of speed times turning rate.
  const double most = base.linear_acceleration + base.linear_velocity * base.angular_velocity;
  check_accelerations_fit(motion, {most, most, base.angular_acceleration}, {"x", "y", "theta"}, where, faults);
}

}  // namespace

void check_base_course(const PlanToCheck& plan, const CheckedMotion& motion, const std::string& where, Faults& faults) {
  const BaseKind base = plan.robot.base;
  std::vector<Vector3d> drive;
  for (std::size_t i = 0; i < motion.times.size(); ++i)
    drive.push_back(drive_of(base, motion.positions[i], motion.velocities[i]));
  check_limits(plan, motion, drive, where, faults);
  if (motion.accelerations.size() == motion.times.size()) check_accelerations(plan, motion, where, faults);
  Vector3d pose = motion.positions.front().head<3>();
  for (std::size_t i = 0; i < drive.size(); ++i) {
    const double t = motion.times[i];
    if (!check_workspace(plan, motion.positions[i].head<3>(), 0, where + ", t = " + text(t) + " s", faults)) return;
    if (i > 0) pose = driven(base, pose, drive[i - 1], drive[i], t - motion.times[i - 1]);
    const Vector3d off = motion.positions[i].head<3>() - pose;
    const double aside = base == BaseKind::diff_drive ? std::abs(drive[i].y()) : 0;
    if (off.cwiseAbs().maxCoeff() <= kOffCourse && aside <= kSideways) continue;
    faults.push_back({"base-off-course", where + ", t = " + text(t) + " s",
                      aside > kSideways ? "the base slides sideways at " + text(aside) + " m/s"
                                        : "its velocities lead to " + text(pose) + ", the plan says " +
                                              text(Vector3d(motion.positions[i].head<3>()))});
    return;
  }
}

}  // namespace mmgrasp::verify::detail
