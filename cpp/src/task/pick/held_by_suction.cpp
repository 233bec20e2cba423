#include "task/pick/held_by_suction.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace mmgrasp::detail {
namespace {

constexpr double kSlower = 1.1;
constexpr int kMostSlowing = 60;
const Eigen::Vector3d kGravity(0, 0, -9.80665);  // [m/s^2]

/// A moment of a motion: how the tool stands, and how the part's centre of mass is accelerated.
struct Moment {
  Eigen::Matrix3d R_world_tool;
  Eigen::Vector3d acceleration;
};

/// Between samples the motion is a cubic, whose acceleration is largest at its ends: it is taken near both.
std::vector<Moment> moments(const JointGroup& arm, const Eigen::Vector3d& centre, const JointTrajectory& motion) {
  std::vector<Moment> found;
  const auto at = [&](double t) { return arm.fk(motion.at(t)) * centre; };
  for (std::size_t i = 1; i < motion.times.size(); ++i) {
    const double from = motion.times[i - 1], length = motion.times[i] - from, step = length / 8;
    for (const double share : {0.125, 0.5, 0.875}) {
      const double t = from + share * length;
      const Eigen::Vector3d bend = at(t - step) - 2 * at(t) + at(t + step);
      found.push_back({arm.fk(motion.at(t)).linear(), bend / (step * step)});
    }
  }
  return found;
}

bool holds(const SuctionLoad& load, const std::vector<Moment>& moments, double slower) {
  return std::all_of(moments.begin(), moments.end(), [&](const Moment& moment) {
    const Eigen::Vector3d pull = moment.R_world_tool.transpose() * (kGravity - moment.acceleration / (slower * slower));
    return suction_share(load.suction, load.approach, load.mass, load.centre_of_mass, pull) <= kSuctionUsed;
  });
}

}  // namespace

bool slow_to_hold(const JointGroup& arm, const SuctionLoad& load, JointTrajectory& motion) {
  const std::vector<Moment> all = moments(arm, load.centre_of_mass, motion);
  double slower = 1;
  for (int i = 0; !holds(load, all, slower); ++i) {
    if (i == kMostSlowing) return false;
    slower *= kSlower;
  }
  for (double& t : motion.times) t *= slower;
  for (Eigen::VectorXd& v : motion.velocities) v /= slower;
  for (Eigen::VectorXd& a : motion.accelerations) a /= slower * slower;
  return true;
}

}  // namespace mmgrasp::detail
