#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/pose.hpp"

namespace mmgrasp {

/// A tray whose place is known: its floor carries the parts, its walls are taken out of the cloud.
struct MMGRASP_EXPORT KnownTray {
  Pose T_world_tray = Pose::Identity();                   ///< Middle of the floor, z up.
  Eigen::Vector3d size = Eigen::Vector3d(0.3, 0.4, 0.1);  ///< Outer x, y and height [m], > 0.
  double wall = 0.005;                                    ///< Thickness of the walls [m], >= 0.
};

/// What fit_cuboids() takes for the supporting plane, for one part, and for noise.
struct MMGRASP_EXPORT CuboidFitOptions {
  double plane_tolerance = 0.008;  ///< Points no farther than this from the supporting plane belong to it [m]; > 0.
  double wall_margin = 0.006;      ///< Points no farther than this from a tray's wall are left out [m]; >= 0.
  /// Upwards; the supporting plane's normal lies within `up_angle` of it. Zero: any plane will do, and up is the side
  /// the scanner stands on.
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  double up_angle = 0.35;           ///< [rad], in (0, pi/2].
  double max_height = 0.5;          ///< Points higher above the plane are left out [m]; > 0.
  double cluster_tolerance = 0.01;  ///< Points farther from each other than this belong to different parts [m]; > 0.
  double leaf = 0.003;              ///< Cell to which points are thinned for the search [m]; > 0, < cluster_tolerance.
  int min_points = 60;              ///< Smaller clusters are left out; >= 8.
  int plane_iterations = 1000;      ///< Random planes tried; > 0.
  void check() const;
};

/// A box-shaped part on its supporting plane.
struct MMGRASP_EXPORT FittedCuboid {
  Pose T_world_box = Pose::Identity();             ///< Its centre; z along the plane's normal, x along the longer side.
  Eigen::Vector3d size = Eigen::Vector3d::Zero();  ///< [m]
  int points = 0;                                  ///< Number that it was fitted to.
  double fill = 0;  ///< Share of the top rectangle's area near which a point of the top was seen: how box-like it is.
};

/// Box-shaped parts found in a cloud, the plane they stand on, and to which of these each point belongs.
struct MMGRASP_EXPORT CuboidFit {
  bool plane_found = false;
  Eigen::Vector3d plane_normal = Eigen::Vector3d::UnitZ();  ///< Unit, upwards.
  double plane_offset = 0;                                  ///< plane_normal . x = plane_offset [m]
  std::vector<FittedCuboid> cuboids;                        ///< Most points first.
  std::vector<int> labels;  ///< One a point: index of its cuboid, -1 the plane, -2 left out or not measured.
};

/// Box-shaped parts in a cloud (P1 3.7.1): the supporting plane and the tray are taken out, what stands on the plane is
/// parted into clusters, and each gets the upright cuboid from the plane to its top face. The rectangle is the one of
/// least area around the top face but for its outermost points; its sides follow from the quartiles of the points, for
/// which noise at the edges and stray points do not matter. The camera's noise therefore moves a side by far less than
/// its own size, if the top is seen whole and evenly. Parts that touch one another are one cluster. With a tray its
/// floor is the supporting plane; else the dominant plane of the cloud is, and what stands beside it is left out.
/// Points that are not finite count as not measured. `eye` is where the scanner stood. Throws InvalidInput on bad
/// options or a bad tray.
MMGRASP_EXPORT CuboidFit fit_cuboids(const std::vector<Eigen::Vector3d>& points, const CuboidFitOptions& options = {},
                                     const std::optional<KnownTray>& tray = std::nullopt,
                                     const Eigen::Vector3d& eye = Eigen::Vector3d::Zero());

}  // namespace mmgrasp
