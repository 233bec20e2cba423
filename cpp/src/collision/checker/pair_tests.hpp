#pragma once

#include "collision/checker/placement.hpp"

/// Do two placed shapes touch? Two of the robot's own, or one of them and one of the scene. The answers are exact; what
/// sphere covers can prove, they prove.
namespace mmgrasp::detail {

/// Clearances are not proven for bodies that move farther than this: hardly any would be as wide [m].
constexpr double kMaxProvenMotion = 0.1;

bool pair_collides(Placement& placement, const ShapePair& pair);
bool scene_collides(Placement& placement, int shape, int scene_shape);

/// What the covers of the two prove. With `motion` > 0 [m] kApart means that they stay apart while they come no more
/// than that closer, and kMaybe proves nothing.
CoverAnswer pair_by_covers(Placement& placement, const ShapePair& pair, double motion = 0);
CoverAnswer scene_by_covers(Placement& placement, int shape, int scene_shape, double motion = 0);

/// The same answers without covers, for pairs that those left open.
bool pair_collides_exactly(Placement& placement, const ShapePair& pair);
bool scene_collides_exactly(Placement& placement, int shape, int scene_shape);

/// Whether the two touch (kOverlap), stay apart while they come no more than `motion` [m] closer (kApart), or neither
/// is proven. Without motion only the first is decided. `hulls_meet`: whether their hulls did lately, so that those are
/// not tested; set when they do.
CoverAnswer pair_within(Placement& placement, const ShapePair& pair, double motion, char& hulls_meet);
CoverAnswer scene_within(Placement& placement, int shape, int scene_shape, double motion);

}  // namespace mmgrasp::detail
