#pragma once

#include <cstdint>

#include "mmgrasp/reach/reach_database.hpp"
#include "support/small_robots.hpp"

namespace mmgrasp::test {

inline JointGroup gantry() {
  return Robot::from_strings(gantry_urdf()).chain("base", "c");
}
inline JointGroup seven_joints() {
  return Robot::from_strings(seven_joint_urdf()).chain("column", "tool");
}

inline ReachOptions with_samples(std::int64_t samples, double min_manipulability = 0.02) {
  ReachOptions options;
  options.samples = samples;
  options.min_manipulability = min_manipulability;
  return options;
}

}  // namespace mmgrasp::test
