#pragma once

#include <memory>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/geometry/distance_field.hpp"

namespace mmgrasp {

/// What a distance field holds, as an obstacle of a World.
///
/// Checks call a body free only when the field proves it: every point of the body is farther from the surface than
/// zero (or the padding), whatever the true distances within the field's error. A body whose true distance exceeds
/// 2 error + resolution (beyond the padding) is called free; between the two it is called colliding. With an exact
/// field the answer is that of the body itself but for a band of `resolution`.
struct MMGRASP_EXPORT FieldObstacle {
  std::shared_ptr<const DistanceField> field;
  Pose T_world_field = Pose::Identity();
  /// Pieces of a body are halved until a distance decides or they are this small [m]; > 0. Time grows with its inverse
  /// where bodies come that near.
  double resolution = 1e-3;
  /// What the field does not know: free, or an obstacle. Outside the domain this holds to the point. Inside, NaN is
  /// taken so where it is met: a map in which unseen cells are obstacles gives the distances to them. Unknown points
  /// are free for a body's own points alone: where it is rounded (spheres, capsules) or padded, for distances and for
  /// continuous edges they are obstacles, since nothing tells how far what is known lies from them.
  bool unknown_is_free = false;
  void check() const;  ///< Throws InvalidInput.
};

}  // namespace mmgrasp
