#include "verify/motion/motion_limits.hpp"

#include <algorithm>
#include <cmath>

#include "verify/motion/hermite.hpp"
#include "verify/motion/stored_accelerations.hpp"

namespace mmgrasp::verify::detail {
namespace {

constexpr double kPositionSlack = 1e-5;  // [rad] or [m]; what limits and values printed to five digits lose
constexpr double kRateSlack = 0.01;      // Relative, velocities at samples and accelerations.
constexpr double kLargest = 1e6;  // No position [rad, m] or speed is beyond this: it would only break the arithmetic.
constexpr double kBetweenSlack =
    0.05;  // Relative, velocities between samples: a cubic overshoots a trapezoid's corner.

bool usable(const Eigen::VectorXd& values, int joints) {
  return values.size() == joints && (values.array().abs() <= kLargest).all();  // false for NaN
}

/// The worst excess over a bound that was seen.
struct Worst {
  double excess = 0, value = 0, bound = 0, time = 0;
  int joint = -1;

  void see(double excess_now, double value_now, double bound_now, int joint_now, double time_now) {
    if (excess_now <= excess) return;
    excess = excess_now;
    value = value_now;
    bound = bound_now;
    joint = joint_now;
    time = time_now;
  }
};

void report(const Worst& worst, const char* code, const char* quantity, const char* unit, const Context& context,
            const std::string& where, Faults& faults) {
  if (worst.joint < 0) return;
  faults.push_back({code, where + ", t = " + text(worst.time) + " s",
                    std::string(quantity) + " of '" + context.plan.arm_joints[worst.joint] + "' is " +
                        text(worst.value) + ", the limit " + text(worst.bound) + " " + unit});
}

/// The accelerations a plan stores besides: as many as samples, within the limits, and those of the cubics.
void check_stored_accelerations(const Context& context, const CheckedMotion& motion, const std::string& where,
                                Faults& faults) {
  if (motion.accelerations.empty()) return;
  const std::vector<double>& limits = context.plan.acceleration_limits;
  bool good = motion.accelerations.size() == motion.times.size();
  for (const Eigen::VectorXd& a : motion.accelerations) {
    good = good && static_cast<std::size_t>(a.size()) == limits.size();
    for (std::size_t j = 0; good && j < limits.size(); ++j) {
      good = std::abs(a[static_cast<Eigen::Index>(j)]) <= (1 + kRateSlack) * limits[j];  // false for NaN
    }
  }
  if (!good) {
    faults.push_back({"acceleration", where,
                      "the stored accelerations must be one a sample and joint, each within the acceleration limits"});
    return;
  }
  check_accelerations_fit(motion, limits, context.plan.arm_joints, where, faults);
}

}  // namespace

bool check_motion_shape(const CheckedMotion& motion, int joints, const std::string& where, Faults& faults) {
  const std::size_t samples = motion.times.size();
  if (samples < 2 || motion.positions.size() != samples || motion.velocities.size() != samples) {
    faults.push_back({"motion-shape", where,
                      "has " + text(samples) + " times, " + text(motion.positions.size()) + " positions, " +
                          text(motion.velocities.size()) + " velocities: must be equally many, at least 2"});
    return false;
  }
  for (std::size_t i = 0; i < samples; ++i) {
    const bool good = usable(motion.positions[i], joints) && usable(motion.velocities[i], joints) &&
                      std::abs(motion.times[i]) <= kLargest;
    if (!good) {
      faults.push_back({"motion-shape", where,
                        "sample " + std::to_string(i) + " does not hold a time and " + std::to_string(joints) +
                            " positions and velocities, all finite and at most 1e6"});
      return false;
    }
    if (i == 0 && motion.times[0] != 0) {
      faults.push_back({"times", where, "begins at " + text(motion.times[0]) + " s: must be 0, the clock is its own"});
      return false;
    }
    if (i > 0 && !(motion.times[i] > motion.times[i - 1])) {
      faults.push_back({"times", where,
                        "time " + std::to_string(i) + " (" + text(motion.times[i]) + " s) does not come after " +
                            text(motion.times[i - 1]) + " s"});
      return false;
    }
  }
  return true;
}

void check_motion_limits(const Context& context, const Kinematics& kinematics, const CheckedMotion& motion,
                         const std::string& where, Faults& faults) {
  check_stored_accelerations(context, motion, where, faults);
  Worst position, velocity, acceleration;
  for (std::size_t i = 0; i + 1 < motion.times.size(); ++i) {
    const HermiteSegment segment(motion, i);
    const double t = motion.times[i];
    for (int j = 0; j < kinematics.arm_size(); ++j) {
      const Range q = segment.position_range(j);
      position.see(kinematics.lower()[j] - kPositionSlack - q.low, q.low, kinematics.lower()[j], j, t);
      position.see(q.high - kinematics.upper()[j] - kPositionSlack, q.high, kinematics.upper()[j], j, t);

      const double v_limit = context.plan.velocity_limits[j];
      const double at_samples = std::max(std::abs(motion.velocities[i][j]), std::abs(motion.velocities[i + 1][j]));
      const Range v = segment.velocity_range(j);
      const double between = std::max(-v.low, v.high);
      velocity.see(at_samples / v_limit - 1 - kRateSlack, at_samples, v_limit, j, t);
      velocity.see(between / v_limit - 1 - kBetweenSlack, between, v_limit, j, t);

      const double a_limit = context.plan.acceleration_limits[j];
      const double a = segment.needed_acceleration(j);
      acceleration.see(a / a_limit - 1 - kRateSlack, a, a_limit, j, t);
    }
  }
  report(position, "position-limit", "position", "rad or m", context, where, faults);
  report(velocity, "velocity-limit", "velocity", "rad/s or m/s", context, where, faults);
  report(acceleration, "acceleration-limit", "acceleration", "rad/s^2 or m/s^2", context, where, faults);
}

}  // namespace mmgrasp::verify::detail
