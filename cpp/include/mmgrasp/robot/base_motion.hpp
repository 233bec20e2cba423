#pragma once

#include <Eigen/Core>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/robot/planar_base.hpp"

namespace mmgrasp {

/// Velocity command of the platform (v_x, v_y, omega), in its own frame, for velocities of the virtual joints x, y,
/// theta standing at heading theta (P3 3.12), and back.
MMGRASP_EXPORT Eigen::Vector3d platform_velocity(double theta, const Eigen::Vector3d& joint_velocity);
MMGRASP_EXPORT Eigen::Vector3d joint_velocity(double theta, const Eigen::Vector3d& platform_velocity);

/// Rim speeds of a diff-drive's wheels [m/s] and back: v = (left + right) / 2, omega = (right - left) / W with W the
/// wheel separation (P1 4.11; its R_base must be W, see docs/errata.md).
struct MMGRASP_EXPORT WheelSpeeds {
  double left = 0, right = 0;
};
MMGRASP_EXPORT WheelSpeeds wheel_speeds(double v, double omega, double wheel_separation);
MMGRASP_EXPORT Eigen::Vector3d platform_velocity(const WheelSpeeds& wheels, double wheel_separation);

/// Rim speeds of all driven wheels are these rows times the platform velocity (v_x, v_y, omega), and wheel_velocity
/// bounds each: v_x -+ omega W / 2 of a diff-drive (left, right); v_x -+ v_y -+ omega (W + B) / 2 of Mecanum wheels
/// with rollers at 45 degrees (front left, front right, rear left, rear right), B the wheelbase. No rows where no wheel
/// sets a limit.
using WheelRows = Eigen::Matrix<double, Eigen::Dynamic, 3>;
MMGRASP_EXPORT WheelRows wheel_rows(BaseKind kind, const BaseLimits& limits);

/// The most that a rim runs [m] per share of a straight way (x, y, theta), driven and turned at once from heading
/// `theta`: the fastest wheel at the heading on the way that asks the most of it. 0 without rows.
MMGRASP_EXPORT double largest_rim_travel(const WheelRows& rows, double theta, const Eigen::Vector3d& way);

/// Largest factor in [0, 1] by which a platform velocity must be scaled to keep every limit of the base kind: speed,
/// turning, wheels. A diff-drive cannot move sideways: a v_y beyond 1e-9 of the rest gives 0, as does any motion of a
/// fixed base. Every function here throws InvalidInput for numbers that are not finite and separations that are not
/// positive.
MMGRASP_EXPORT double velocity_scale(BaseKind kind, const BaseLimits& limits, const Eigen::Vector3d& platform_velocity);

/// The limits with speed and turning rate lowered to what they can be one at a time: what times straight drives and
/// turns on the spot.
MMGRASP_EXPORT BaseLimits driving_limits(BaseKind kind, const BaseLimits& limits);

}  // namespace mmgrasp
