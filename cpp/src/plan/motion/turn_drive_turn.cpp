#include "plan/motion/turn_drive_turn.hpp"

#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {
namespace {

constexpr double kNoDrive = 1e-9;  // Shorter drives are left out [m].

double turn(double from, double to) {
  return shortest_turn(to - from);
}

/// `angle` plus the whole turns that bring it nearest to `near`.
double in_turn_of(double angle, double near) {
  return angle + whole_turns(near - angle);
}

}  // namespace

void append_turn_drive_turn(const Eigen::VectorXd& from, const Eigen::VectorXd& to,
                            std::vector<Eigen::VectorXd>& corners) {
  const Eigen::Vector2d motion = to.head<2>() - from.head<2>();
  const double drive = motion.norm();
  if (drive < kNoDrive) {
    corners.push_back(to);
    corners.back()[2] = in_turn_of(to[2], from[2] + turn(from[2], to[2]));
    return;
  }
  // Brought to [0, pi), so that both directions of travel see the same two headings in the same order.
  double heading = std::atan2(motion[1], motion[0]);
  if (heading < 0) heading += kPi;
  if (heading >= kPi) heading -= kPi;
  const auto turning = [&](double h) { return std::abs(turn(from[2], h)) + std::abs(turn(h, to[2])); };
  if (turning(heading + kPi) < turning(heading)) heading += kPi;
  const double first = turn(from[2], heading), second = turn(heading, to[2]);
  const double total = std::abs(first) + drive + std::abs(second);

  const auto corner = [&](double share, bool driven, double theta) {
    Eigen::VectorXd q = from + share * (to - from);
    q.head<2>() = (driven ? to : from).head<2>();
    q[2] = theta;
    corners.push_back(std::move(q));
  };
  if (std::abs(first) > 1e-12) corner(std::abs(first) / total, false, from[2] + first);
  if (std::abs(second) > 1e-12) corner((std::abs(first) + drive) / total, true, from[2] + first);
  corners.push_back(to);
  corners.back()[2] = in_turn_of(to[2], from[2] + first + second);
}

}  // namespace mmgrasp::detail
