#pragma once

#include "mmgrasp/robot/robot.hpp"

namespace bench {

/// The topmost link that only fixed joints lie between: links of one assembly cannot move against each other.
inline int assembly_of(const mmgrasp::Robot& robot, int link) {
  while (robot.links()[link].parent_joint >= 0 &&
         robot.joints()[robot.links()[link].parent_joint].type == mmgrasp::JointType::fixed)
    link = robot.joints()[robot.links()[link].parent_joint].parent_link;
  return link;
}

}  // namespace bench
