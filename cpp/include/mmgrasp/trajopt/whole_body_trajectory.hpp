#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/robot/joint_group.hpp"
#include "mmgrasp/robot/trajectory.hpp"

namespace mmgrasp {

/// Waypoints of base and arm on one clock. Between them drive velocities (see drive_names) are linear in time.
///
///     const WholeBodyTrajectory& motion = *plan_drive_by(group, world, start, tasks, goal).trajectory;
///     for (double t = 0; t < motion.duration(); t += 0.01) command(motion.at(t), motion.drive_at(t));
class MMGRASP_EXPORT WholeBodyTrajectory {
 public:
  WholeBodyTrajectory(const JointGroup& group, std::vector<double> times, std::vector<Eigen::VectorXd> positions,
                      std::vector<Eigen::VectorXd> drive);

  const JointGroup& group() const { return group_; }
  std::size_t size() const { return times_.size(); }
  double duration() const { return times_.empty() ? 0 : times_.back(); }
  const std::vector<double>& times() const { return times_; }
  const std::vector<Eigen::VectorXd>& positions() const { return positions_; }
  const std::vector<Eigen::VectorXd>& drive() const { return drive_; }

  /// Drive velocity at a time, clamped at the ends.
  Eigen::VectorXd drive_at(double time) const;
  /// Configuration at a time: joints in closed form, the base integrated from the waypoint before it.
  Eigen::VectorXd at(double time) const;
  /// What a base does that only knows the drive velocities: integrated from the first waypoint alone, with
  /// `steps` Runge-Kutta steps per interval. At the waypoints.
  std::vector<Eigen::VectorXd> rolled_out(int steps = 64) const;

  /// Every waypoint and `between` equally spaced samples after each, with velocities and accelerations of the
  /// configuration.
  JointTrajectory sampled(int between = 0) const;
  /// Header "time,<name>,...,<name>.velocity,...,<name>.acceleration,..."; with a base also "base.v,base.vy,base.omega"
  /// in the platform's frame, and for a diff-drive "wheel.left,wheel.right" [m/s]. 17 digits.
  std::string to_csv(int between = 0) const;

 private:
  std::size_t interval(double time) const;
  JointGroup group_;
  std::vector<double> times_;
  std::vector<Eigen::VectorXd> positions_, drive_;
};

}  // namespace mmgrasp
