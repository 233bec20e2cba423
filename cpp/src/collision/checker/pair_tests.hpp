#pragma once

#include "collision/checker/placement.hpp"
#include "collision/narrow/convex_clearance.hpp"

/// Do two placed shapes touch? Two of the robot's own, or one of them and one of the scene. The answers are exact; what
/// sphere covers can prove, they prove.
namespace mmgrasp::detail {

/// Clearances are not proven for bodies that move farther than this: hardly any would be as wide [m].
constexpr double kMaxProvenMotion = 0.05;

bool pair_collides(Placement& placement, const ShapePair& pair);
bool scene_collides(Placement& placement, int shape, int scene_shape);

/// The two collide (as known already), but only because they are padded.
bool only_padding_meets(Placement& placement, int shape, int scene_shape);

/// What the covers of the two prove.
CoverAnswer pair_by_covers(Placement& placement, const ShapePair& pair);
CoverAnswer scene_by_covers(Placement& placement, int shape, int scene_shape);

/// The same answers without covers, for pairs that those left open.
bool pair_collides_exactly(Placement& placement, const ShapePair& pair);
bool scene_collides_exactly(Placement& placement, int shape, int scene_shape);

/// What is remembered of two shapes from one configuration to the next.
struct PairMemory {
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();  ///< Direction that parted their hulls last: any is a valid start.
  bool hulls_meet = false;                         ///< Their hulls did lately: they are not tested again.
};

/// What is known of two shapes where they are, and while they come closer.
struct Within {
  bool touch = false;
  double share = 0;  ///< How much of the closing's stretch they surely stay apart for; 1: all of it.
};

/// Where they come no closer (`closing.most` 0) only `touch` is decided.
Within pair_within(Placement& placement, const ShapePair& pair, const Closing& closing, PairMemory& memory);
Within scene_within(Placement& placement, int shape, int scene_shape, const Closing& closing);

}  // namespace mmgrasp::detail
