#pragma once

#include "collision/narrow/closing.hpp"
#include "collision/narrow/solid.hpp"
#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {

/// True when a, placed at T_a, and b at T_b touch (or come within the sum of their margins). Closed meshes are solid.
/// With `more` > 0 [m], false means that they are farther apart by more than that; true proves nothing. `hulls_meet`:
/// the hulls around them are known to. `hit_piece` is set to
/// the triangle or voxel of the one that is found to meet the other one, a convex body.
MMGRASP_EXPORT bool solids_collide(const Solid& a, const Rigid& T_a, const Solid& b, const Rigid& T_b, double more = 0,
                                   bool hulls_meet = false, int* hit_piece = nullptr);

/// The same for that piece alone; false where not one of the two is convex and the other one in pieces.
MMGRASP_EXPORT bool piece_collides(const Solid& a, const Rigid& T_a, const Solid& b, const Rigid& T_b, int piece);

class DistanceGrid;
/// The same answer for two meshes whose bodies are known to be close, sooner: `grid` is that of a and rules out
/// triangles of b; `hulls_meet`: their hulls are known to meet. Where one of them moves (`closing`, world frame), false
/// means that they do not meet on the way; true proves nothing.
MMGRASP_EXPORT bool meshes_collide(const Solid& a, const Rigid& T_a, const DistanceGrid& grid, const Solid& b,
                                   const Rigid& T_b, const Closing& closing = {}, bool hulls_meet = false);

/// distance = normal . (on_a - on_b).
struct SolidClearance {
  double distance = kInfinity;                     ///< [m]; negative when they overlap.
  Eigen::Vector3d on_a = Eigen::Vector3d::Zero();  ///< World frame.
  Eigen::Vector3d on_b = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal =
      Eigen::Vector3d::UnitX();  ///< Unit, world frame, the direction in which a moves away from b.
};

/// Clearance between the two, margins not counted. Exact below `bound`; otherwise the distance is infinite. Overlap:
/// the exact depth for convex bodies; for meshes that of their hulls (bounding boxes where there is no hull), which no
/// shift needs to exceed; for voxels that of the deepest cell.
MMGRASP_EXPORT SolidClearance solids_distance(const Solid& a, const Rigid& T_a, const Solid& b, const Rigid& T_b,
                                              double bound = kInfinity);

/// A number the distance is not below, from bounding boxes; cheap. Minus infinity for planes and where boxes overlap.
double boxes_clearance(const Solid& a, const Rigid& T_a, const Solid& b, const Rigid& T_b);

}  // namespace mmgrasp::detail
