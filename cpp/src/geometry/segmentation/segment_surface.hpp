#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "geometry/segmentation/convex_parts.hpp"
#include "mmgrasp/geometry/fit_primitives.hpp"

namespace mmgrasp::detail {

/// The faces of one segment, moved and scaled so that it is of size 1 around the origin.
struct SegmentSurface {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< Place of the surface's origin in the mesh [m].
  double scale = 1;                                  ///< Metres of one unit.
  std::vector<std::array<Eigen::Vector3d, 3>> corners;
  std::vector<Eigen::Vector3d> face_normals;
  std::vector<std::array<Eigen::Vector3d, 3>> corner_normals;  ///< At each face's corners, as `normals`.
  std::vector<double> areas;
  double area = 0;
  /// Corners with their normals: the mean of the faces there that bend by less than 40 degrees. Each once.
  std::vector<Eigen::Vector3d> points, normals;
  RegionHull hull;

  Eigen::Vector3d to_mesh(const Eigen::Vector3d& x) const { return origin + scale * x; }
};

/// What faces count by in the normal of a corner: their angle there, so that it does not matter how a wall is cut into
/// triangles, or their area, so that a narrow band beside a wall does not tilt it.
enum class CornerWeight { angle, area };

SegmentSurface segment_surface(const TriangleMesh& mesh, const std::vector<int>& faces,
                               CornerWeight weight = CornerWeight::angle);

/// A round primitive as long as the segment, and where its outward wall is: the faces of a bore that runs on through
/// the next body are the segment's, too, but there is nothing to hold.
struct RoundCandidate {
  FittedPrimitive primitive;
  Eigen::Vector3d wall_middle = Eigen::Vector3d::Zero();  ///< On the axis [m].
  double wall_length = 0;                                 ///< [m]
  double spread = 0;  ///< Mean distance of the points that it was fitted to from it [m].
  void trim();        ///< Makes a cylinder as long as its wall.
};

/// Round primitives with outward surface around at least half a turn (a sphere: a quarter of it), in the mesh's frame.
std::vector<RoundCandidate> round_candidates(const SegmentSurface& surface, const Monitor& monitor);

/// The same for round outlines of surfaces that are not round themselves: models on the hull of the segment, through
/// the crests of its grooves, flutes or knurls, with surface close behind at least half of what lies between their
/// ends.
std::vector<RoundCandidate> outline_candidates(const SegmentSurface& surface, const Monitor& monitor);

/// The box around the segment of the least volume that is aligned with a large flat part of it, or with none.
FittedPrimitive box_candidate(const SegmentSurface& surface);

}  // namespace mmgrasp::detail
