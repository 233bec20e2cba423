#include "mmgrasp/trajopt/whole_body_trajectory.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/robot/base_motion.hpp"
#include "mmgrasp/trajopt/whole_body_problem.hpp"
#include "trajopt/unicycle_arc.hpp"

namespace mmgrasp {
namespace {

/// Samples between two of so many waypoints, so that all together stay small beside memory.
double most_between(std::size_t waypoints) {
  constexpr double kMostSamples = 1e6;
  return std::floor(kMostSamples / static_cast<double>(waypoints));
}

}  // namespace
namespace {

using Eigen::VectorXd;

void append_number(std::string& text, double value) {
  char digits[40];
  const auto end = std::to_chars(digits, digits + sizeof(digits), value, std::chars_format::general, 17).ptr;
  text += ',';
  text.append(digits, end);
}

}  // namespace

WholeBodyTrajectory::WholeBodyTrajectory(const JointGroup& group, std::vector<double> times,
                                         std::vector<VectorXd> positions, std::vector<VectorXd> drive)
    : group_(group), times_(std::move(times)), positions_(std::move(positions)), drive_(std::move(drive)) {
  require(times_.size() >= 2, "times", static_cast<double>(times_.size()), "must hold at least two waypoints");
  require(positions_.size() == times_.size(), "positions", static_cast<double>(positions_.size()),
          "must hold one configuration per time");
  require(drive_.size() == times_.size(), "drive", static_cast<double>(drive_.size()),
          "must hold one velocity per time");
  const Eigen::Index drives = static_cast<Eigen::Index>(drive_names(group).size());
  for (std::size_t i = 0; i < times_.size(); ++i) {
    const std::string at = "[" + std::to_string(i) + "]";
    require_number(times_[i], "times" + at);
    require((i == 0 || times_[i] > times_[i - 1]), "times" + at, times_[i], "must be finite and increase");
    group.check_configuration(positions_[i], "positions" + at);
    require(drive_[i].size() == drives && drive_[i].allFinite(), "drive" + at, static_cast<double>(drive_[i].size()),
            "must be finite with " + std::to_string(drives) + " entries");
  }
}

std::size_t WholeBodyTrajectory::interval(double time) const {
  const auto after = std::upper_bound(times_.begin() + 1, times_.end() - 1, time);
  return after - times_.begin() - 1;
}

VectorXd WholeBodyTrajectory::drive_at(double time) const {
  const std::size_t i = interval(time);
  const double s = std::clamp((time - times_[i]) / (times_[i + 1] - times_[i]), 0.0, 1.0);
  return (1 - s) * drive_[i] + s * drive_[i + 1];
}

VectorXd WholeBodyTrajectory::at(double time) const {
  if (time <= times_.front()) return positions_.front();
  if (time >= times_.back()) return positions_.back();
  const std::size_t i = interval(time);
  const double h = times_[i + 1] - times_[i], s = (time - times_[i]) / h;
  const VectorXd &from = drive_[i], &to = drive_[i + 1];
  const VectorXd way = h * (from * (s - 0.5 * s * s) + to * (0.5 * s * s));
  VectorXd q = positions_[i];
  if (moving_base(group_) != BaseKind::diff_drive) return q + way;
  q.tail(q.size() - 2) += way.tail(way.size() - 1);
  detail::UnicycleArc arc;
  detail::UnicycleArc::Locals locals;
  locals << positions_[i][2], from[1], to[1], from[0], to[0], h;
  arc.evaluate(locals, s, 0);
  q.head<2>() += arc.way;
  return q;
}

std::vector<VectorXd> WholeBodyTrajectory::rolled_out(int steps) const {
  require_within(steps, 1, most_between(times_.size()), "steps", "between two waypoints");
  std::vector<VectorXd> result{positions_.front()};
  VectorXd q = positions_.front();
  for (std::size_t i = 0; i + 1 < times_.size(); ++i) {
    const double h = (times_[i + 1] - times_[i]) / steps;
    const auto rate = [&](const VectorXd& at, double s) {
      return configuration_velocity(group_, at, (1 - s) * drive_[i] + s * drive_[i + 1]);
    };
    for (int k = 0; k < steps; ++k) {
      const double s = static_cast<double>(k) / steps, ds = 0.5 / steps;
      const VectorXd a = rate(q, s), b = rate(q + 0.5 * h * a, s + ds), c = rate(q + 0.5 * h * b, s + ds),
                     d = rate(q + h * c, s + 2 * ds);
      q += h / 6 * (a + 2 * b + 2 * c + d);
    }
    result.push_back(q);
  }
  return result;
}

JointTrajectory WholeBodyTrajectory::sampled(int between) const {
  require_within(between, 0, most_between(times_.size()), "between", "samples between two waypoints");
  JointTrajectory result;
  result.names = group_.names();
  const bool diff_drive = moving_base(group_) == BaseKind::diff_drive;
  for (std::size_t i = 0; i < times_.size(); ++i) {
    const std::size_t from = std::min(i, times_.size() - 2);
    const double h = times_[from + 1] - times_[from];
    const VectorXd slope = (drive_[from + 1] - drive_[from]) / h;
    for (int k = 0; k <= (i + 1 < times_.size() ? between : 0); ++k) {
      const double time = times_[i] + h * k / (between + 1);
      const VectorXd q = k == 0 ? positions_[i] : at(time), drive = k == 0 ? drive_[i] : drive_at(time);
      VectorXd acceleration = configuration_velocity(group_, q, slope);
      if (diff_drive) {  // the direction of v turns
        acceleration[0] -= drive[0] * drive[1] * std::sin(q[2]);
        acceleration[1] += drive[0] * drive[1] * std::cos(q[2]);
      }
      result.times.push_back(time);
      result.positions.push_back(q);
      result.velocities.push_back(configuration_velocity(group_, q, drive));
      result.accelerations.push_back(acceleration);
    }
  }
  return result;
}

std::string WholeBodyTrajectory::to_csv(int between) const {
  const JointTrajectory samples = sampled(between);
  const BaseKind base = moving_base(group_);
  const std::string plain = samples.to_csv();
  if (base == BaseKind::fixed) return plain;
  const double separation = group_.robot().base_limits().wheel_separation;
  std::string text;
  std::size_t from = 0;
  for (std::size_t line = 0; line <= samples.times.size(); ++line) {
    const std::size_t end = plain.find('\n', from);
    text.append(plain, from, end - from);
    from = end + 1;
    if (line == 0) {
      text += ",base.v,base.vy,base.omega";
      if (base == BaseKind::diff_drive) text += ",wheel.left,wheel.right";
    } else {
      const Eigen::VectorXd& q = samples.positions[line - 1];
      const Eigen::Vector3d twist = platform_velocity(q[2], samples.velocities[line - 1].head<3>());
      append_number(text, twist[0]);
      append_number(text, base == BaseKind::diff_drive ? 0.0 : twist[1]);
      append_number(text, twist[2]);
      if (base == BaseKind::diff_drive) {
        const WheelSpeeds wheels = wheel_speeds(twist[0], twist[2], separation);
        append_number(text, wheels.left);
        append_number(text, wheels.right);
      }
    }
    text += '\n';
  }
  return text;
}

}  // namespace mmgrasp
