#pragma once

#include "collision/narrow/closing.hpp"
#include "collision/narrow/convex.hpp"

namespace mmgrasp::detail {

/// How two convex bodies lie to each other: distance = normal . (on_a - on_b), negative when they overlap.
struct ConvexClearance {
  double distance = 0;                                ///< [m]; negative: how far one must be moved to part them.
  Eigen::Vector3d on_a = Eigen::Vector3d::Zero();     ///< Witness points, frame of a.
  Eigen::Vector3d on_b = Eigen::Vector3d::Zero();     ///< The deepest ones when the bodies overlap.
  Eigen::Vector3d normal = Eigen::Vector3d::UnitX();  ///< Unit, frame of a, the direction in which a moves away from b.
};

enum class ClearanceKind {
  beyond,      ///< Not nearer than the bound: nothing was filled in.
  apart,       ///< The cores are apart: exact, also where roundings overlap.
  overlapping  ///< The cores meet: nothing was filled in.
};

/// Clearance by GJK between a and b placed at `b_in_a`, given up as soon as it is known not to be below `bound`. `axis`
/// (frame of a, from b to a) is where the search starts and, unless the cores meet, the direction of the clearance on
/// return.
ClearanceKind convex_clearance(const Convex& a, const Convex& b, const Rigid& b_in_a, double bound,
                               Eigen::Vector3d& axis, ConvexClearance& clearance);

enum class Nearness { beyond, near, touching };

/// Whether the clearance of two convex bodies is more than `touch` [m] even after they came closer as `closing` says
/// (frame of a; beyond), not proven to be (near, but more than `touch`), or not proven to be more than `touch`: GJK
/// that stops as soon as one of the three is certain. `axis` (frame of a, from b to a; zero: none) is where the search
/// starts and, on return, the last direction looked along. `share`: how much of the closing's stretch the clearance
/// lasts for, as far as known.
Nearness convex_nearness(const Convex& a, const Convex& b, const Rigid& b_in_a, const Closing& closing, double touch,
                         Eigen::Vector3d& axis, double& share);

/// Clearance of bodies whose cores meet, by the expanding polytope algorithm: exact for polytopes, for round ones to
/// 1e-12 of their size.
ConvexClearance convex_penetration(const Convex& a, const Convex& b, const Rigid& b_in_a);

}  // namespace mmgrasp::detail
