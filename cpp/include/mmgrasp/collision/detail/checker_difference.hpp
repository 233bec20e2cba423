#pragma once

#include <string>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/core/export.hpp"

namespace mmgrasp::detail {

/// What keeps a prepared checker from standing in for one of this group and world, in words ("its world lacks
/// 'table'"); empty when nothing does: the same robot, joints, tip, values held and root, and equal worlds.
MMGRASP_EXPORT std::string checker_difference(const CollisionChecker& checker, const JointGroup& group,
                                              const World& world);

}  // namespace mmgrasp::detail
