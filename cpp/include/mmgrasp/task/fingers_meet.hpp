#pragma once

#include <vector>

#include "mmgrasp/collision/world.hpp"
#include "mmgrasp/core/export.hpp"
#include "mmgrasp/grasp/hand.hpp"
#include "mmgrasp/robot/joint_group.hpp"

namespace mmgrasp {

/// How far off a grasp an arm may stand that reaches it within the tolerances of a plan's own check [m].
constexpr double kGraspSlack = 2e-4;

/// Tells of each grasp of a part whether finger links of both sides meet the part at once while they close from the
/// grasp's opening down to verify::narrowest_grip(), wherever within kGraspSlack along the closing axis the hand
/// stands: a plan's own check asks for that. Fingers that leave a gap when they are closed cannot hold what is thinner.
/// The arm, whose tip carries the hand, says how all other joints stand; meshes of its robot may stick out by
/// `mesh_tolerance` (RobotOptions) [m] beyond those of the check. Cups have no fingers to close: all true. Throws
/// InvalidInput where the arm's robot lacks a link or joint of the hand, or an opening is beyond the hand's.
MMGRASP_EXPORT std::vector<bool> fingers_meet(const JointGroup& arm, const Hand& hand,
                                              const std::vector<LinkShape>& part, const std::vector<Grasp>& grasps,
                                              double mesh_tolerance = 0);

/// Tells of each grasp of a part whether its finger links keep out of the part until they are as near as its opening
/// says, or verify::grip_play() on either side of it: where a part is wider beside the pads than between them, fingers
/// would stand in it. Arguments and errors as fingers_meet().
MMGRASP_EXPORT std::vector<bool> fingers_fit(const JointGroup& arm, const Hand& hand,
                                             const std::vector<LinkShape>& part, const std::vector<Grasp>& grasps,
                                             double mesh_tolerance = 0);

}  // namespace mmgrasp
