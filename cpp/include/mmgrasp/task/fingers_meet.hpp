#pragma once

#include <vector>

#include "mmgrasp/collision/world.hpp"
#include "mmgrasp/core/export.hpp"
#include "mmgrasp/grasp/hand.hpp"
#include "mmgrasp/robot/robot.hpp"

namespace mmgrasp {

/// Tells of each grasp of a part whether two of the hand's finger links meet the part at once while they close from the
/// grasp's opening down to verify::narrowest_grip(): a plan's own check asks for that. Fingers that leave a gap when
/// they are closed cannot hold what is thinner. Cups have no fingers to close: all true. Throws InvalidInput where the
/// robot lacks a link or joint of the hand.
MMGRASP_EXPORT std::vector<bool> fingers_meet(const Robot& robot, const Hand& hand, const std::vector<LinkShape>& part,
                                              const std::vector<Grasp>& grasps);

}  // namespace mmgrasp
