#pragma once

#include "mmgrasp/grasp/suction.hpp"
#include "mmgrasp/robot/joint_group.hpp"
#include "mmgrasp/robot/trajectory.hpp"

namespace mmgrasp::detail {

/// A part under suction cups.
struct SuctionLoad {
  const Suction& suction;
  Eigen::Vector3d approach;        ///< Tool frame.
  double mass;                     ///< [kg]
  Eigen::Vector3d centre_of_mass;  ///< Its place in the tool frame [m].
};

/// Slows a motion that begins and ends at rest until the cups hold the part all along: less is accelerated then, while
/// at rest they hold it however they are turned. The same path, other times. False: they would not hold it at rest.
bool slow_to_hold(const JointGroup& arm, const SuctionLoad& load, JointTrajectory& motion);

}  // namespace mmgrasp::detail
