#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/robot/planar_base.hpp"
#include "mmgrasp/robot/trajectory.hpp"

namespace mmgrasp {

/// How a base follows a planned motion (P1 4.4.2). The gains are those of P1's figure 4.9.
struct MMGRASP_EXPORT BaseTrackingOptions {
  double kp = 2.0;           ///< Proportional gain of (4.14) [1/s]; >= 0.
  double ki = 0.1;           ///< Integral gain [1/s^2]; >= 0.
  double kd = 0.3;           ///< Derivative gain [-]; >= 0.
  double offset = 0.2;       ///< Distance epsilon of the point P from the wheel axis (4.12, 4.13) [m]; > 0.
  double period = 0.02;      ///< A command is held this long [s]; > 0.
  bool feed_forward = true;  ///< Adds the planned velocity of P; (4.14) as printed has none and so always lags.
  bool feedback = true;      ///< false: open loop, the planned velocities only (figure 4.9 a).
  double settle = 0.0;       ///< Tracking goes on this long after the plan's end [s]; >= 0.
  void check() const;        ///< Throws InvalidInput naming field, value and rule.
};

/// The feedback law (P1 4.4.2): from planned and measured base pose to the velocity that the platform is to hold for a
/// period.
///
/// Diff-drive: the point P at `offset` ahead of the wheel axis can move any way, [v, omega] = diag(1, 1/offset)
/// R(-theta) P'. P' is the plan's velocity of P plus the PID terms of (4.14) on the error of P (4.15). Where the plan
/// drives backwards P lies behind the axis, since a point ahead of a reversing base turns it round. Omni: the three
/// errors themselves, in the world. Commands beyond the limits of speed, turning rate and wheels are scaled down as a
/// whole, which keeps their curvature; the integral then rests.
/// @code
///   BaseTracker tracker(BaseKind::diff_drive, robot.base_limits());
///   drive(tracker.command(plan_at(t), plan_at(t + tracker.options().period), localised_pose));
/// @endcode
class MMGRASP_EXPORT BaseTracker {
 public:
  /// Throws InvalidInput for a fixed base, limits or options out of range.
  BaseTracker(BaseKind kind, const BaseLimits& limits, const BaseTrackingOptions& options = {});

  void reset();
  /// Platform velocity (v_x, v_y, omega) to hold until the plan is at `desired_next`, one period after `desired`; poses
  /// (x, y, theta). Throws InvalidInput for numbers that are not finite.
  Eigen::Vector3d command(const Eigen::Vector3d& desired, const Eigen::Vector3d& desired_next,
                          const Eigen::Vector3d& measured);
  bool limited() const { return limited_; }  ///< The last command was scaled down.
  const BaseTrackingOptions& options() const { return options_; }

 private:
  Eigen::Vector3d correction(const Eigen::Vector3d& error);

  BaseKind kind_;
  BaseLimits limits_;
  BaseTrackingOptions options_;
  Eigen::Vector3d integral_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d last_error_ = Eigen::Vector3d::Zero();
  bool has_error_ = false;
  bool limited_ = false;
  double side_ = 1;  // +1: P ahead of the axis, -1: behind it
};

/// What comes between a command and the motion, and between the pose and its measurement.
struct MMGRASP_EXPORT BaseDisturbance {
  double slip_left = 0;                                   ///< Share of the left wheel's travel that is lost; in [0, 1).
  double slip_right = 0;                                  ///< The same of the right wheel.
  Eigen::Vector3d drift = Eigen::Vector3d::Zero();        ///< Platform velocity added [m/s, rad/s].
  double travel_noise = 0;                                ///< Deviation of a wheel's travel after 1 m [m]; grows with
                                                          ///< the root of the travel; >= 0.
  double position_noise = 0;                              ///< Deviation of a measured x or y [m]; >= 0.
  double heading_noise = 0;                               ///< Deviation of a measured heading [rad]; >= 0.
  Eigen::Vector3d start_error = Eigen::Vector3d::Zero();  ///< Pose at the beginning less the planned one (x, y, theta).
  unsigned seed = 1;                                      ///< Same seed, same run.
  void check() const;                                     ///< Throws InvalidInput naming field, value and rule.
};

/// A run, one entry per period; commands have one entry less than poses.
struct MMGRASP_EXPORT BaseTrackingResult {
  std::vector<double> times;                     ///< [s]
  std::vector<Eigen::Vector3d> desired, actual;  ///< Poses (x, y, theta).
  std::vector<Eigen::Vector3d> commands;         ///< Platform velocities.
  std::vector<double> position_errors;           ///< Distance of actual from desired [m].
  std::vector<double> heading_errors;            ///< Desired less actual heading, in (-pi, pi] [rad].
  std::size_t limited = 0;                       ///< Commands that were scaled down to the limits.
  double mean_error() const;                     ///< [m]
  double max_error() const;                      ///< [m]
  double final_error() const;                    ///< [m]
};

/// Simulates a base that tracks a plan, a trajectory with the columns x, y, theta: commands from BaseTracker, motion by
/// exact arcs, disturbances between them. Slip of the two wheels must be equal for an omni base, whose every component
/// then loses that share. Throws InvalidInput when the trajectory has no such columns or samples, for a fixed base, and
/// for options out of range.
/// @code
///   BaseDisturbance slip;
///   slip.slip_left = 0.02;
///   const BaseTrackingResult run = track_base(plan, BaseKind::diff_drive, robot.base_limits(), {}, slip);
///   std::cout << "largest error " << run.max_error() << " m\n";
/// @endcode
MMGRASP_EXPORT BaseTrackingResult track_base(const JointTrajectory& plan, BaseKind kind, const BaseLimits& limits,
                                             const BaseTrackingOptions& options = {},
                                             const BaseDisturbance& disturbance = {});

/// Columns of x, y and theta in a trajectory; throws InvalidInput naming the one that is missing.
MMGRASP_EXPORT Eigen::Array3i base_columns(const JointTrajectory& plan);

}  // namespace mmgrasp
