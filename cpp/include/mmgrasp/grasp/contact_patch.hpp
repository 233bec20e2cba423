#pragma once

#include <Eigen/Core>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/grasp/hand_model.hpp"
#include "mmgrasp/mapping/probabilistic_sdf.hpp"

namespace mmgrasp {

/// What a finger's pad meets if it moves on along its normal.
struct MMGRASP_EXPORT ContactPatch {
  Eigen::Vector3d pad_normal = Eigen::Vector3d::UnitZ();  ///< P3's n_i: the way the pad pushes, a unit vector.
  Eigen::Vector3d normal = -Eigen::Vector3d::UnitZ();     ///< P3's c_i: of the fitted plane, away from the object.
  Eigen::Vector3d point = Eigen::Vector3d::Zero();        ///< Middle of the plane's inliers [m].
  double distance = 0;  ///< P3's d_i: from the pad to the plane's inliers along pad_normal, on average [m].
  double nearest = 0;   ///< The same to the nearest hit of all: where the pad touches first [m].
  double sigma = 0;     ///< P3's <sigma(c_i)>: standard deviation of the surface, averaged over the inliers [m].
  double hits = 0;      ///< Share of the rays that meet the surface.
  double inliers = 0;   ///< Share of the hits that lie in the plane.
};

/// How many rays a pad casts, and how much of what they meet must be plane for a stable contact (P3 4.6.2).
struct MMGRASP_EXPORT ContactPatchOptions {
  int rays = 5;                    ///< Along each side of a pad: P3's 25 are 5 x 5; >= 2.
  double min_hits = 0.5;           ///< Share of the rays that must meet the surface, in (0, 1].
  double min_inliers = 0.8;        ///< Share of the hits that must lie in one plane, in (0, 1] (P3 4.6.2).
  double plane_tolerance = 0.002;  ///< Farthest that an inlier lies from the plane [m]; > 0.
  void check() const;
};

/// Rays of a pad, as columns.
struct MMGRASP_EXPORT PadRays {
  Eigen::Matrix3Xd origins, directions;
};

/// The middles of rays x rays equal cells of the pad, all along the pad's normal, in the world.
MMGRASP_EXPORT PadRays pad_rays(const FingerPad& pad, const Pose& T_world_hand,
                                const ContactPatchOptions& options = {});

/// How fitting a plane ended.
enum class PatchState {
  found,   ///< Enough hits, enough of them in one plane.
  missed,  ///< Fewer hits than min_hits.
  uneven,  ///< No plane holds min_inliers of them: no stable contact.
};

/// The patch of `hits`, one entry a ray, directions the pad's normal (P3 4.6.2). Hits beyond `reach` [m] count as
/// missed. The plane is the least squares one where that holds all hits, else the best of planes through three of them,
/// fitted again to its inliers. On `missed` and `uneven` the patch's `hits`, `inliers` and `pad_normal` alone are set.
MMGRASP_EXPORT PatchState fit_contact_patch(const SdfHits& hits, const Eigen::Vector3d& pad_normal, double reach,
                                            ContactPatch& patch, const ContactPatchOptions& options = {});

}  // namespace mmgrasp
