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
  std::vector<double> areas;
  double area = 0;
  /// Corners with their normals: the mean of the faces there that bend by less than 40 degrees. Each once.
  std::vector<Eigen::Vector3d> points, normals;
  RegionHull hull;

  Eigen::Vector3d to_mesh(const Eigen::Vector3d& x) const { return origin + scale * x; }
};

SegmentSurface segment_surface(const TriangleMesh& mesh, const std::vector<int>& faces);

/// A round primitive as long as the segment, and where its outward wall is: the faces of a bore that runs on through
/// the next body are the segment's, too, but there is nothing to hold.
struct RoundCandidate {
  FittedPrimitive primitive;
  Eigen::Vector3d wall_middle = Eigen::Vector3d::Zero();  ///< On the axis [m].
  double wall_length = 0;                                 ///< [m]
  void trim();                                            ///< Makes a cylinder as long as its wall.
};

/// Round primitives with outward surface around at least half a turn (a sphere: a quarter of it), in the mesh's frame.
std::vector<RoundCandidate> round_candidates(const SegmentSurface& surface, const Monitor& monitor);

/// The box around the segment of the least volume that is aligned with a large flat part of it, or with none.
FittedPrimitive box_candidate(const SegmentSurface& surface);

}  // namespace mmgrasp::detail
