#pragma once

#include <string>

#include "mmgrasp/collision/world.hpp"
#include "mmgrasp/core/export.hpp"
#include "mmgrasp/robot/joint_group.hpp"

namespace mmgrasp {

/// The name under which add_floor() puts the ground into a world.
inline constexpr char kFloor[] = "floor";

/// Puts level ground into the world: everything below z = `height` [m] is solid, without an end.
///
/// - What the joints of `group` move (a base's x, y and theta do not count) must keep off it, and so must what is
///   attached: the arm, the hand, an attached part.
/// - All other links may touch it. Wheels stand on it, and no configuration of the group brings any of these links
///   nearer to it.
///
/// Throws InvalidInput when the name "floor" is in use or `height` is not finite.
MMGRASP_EXPORT void add_floor(World& world, const JointGroup& group, double height = 0);

}  // namespace mmgrasp
