#pragma once

#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/core/outcome.hpp"
#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/geometry/mesh.hpp"
#include "mmgrasp/geometry/shape_diameter.hpp"

namespace mmgrasp {

/// How segment_mesh() divides a surface: into how many classes of thickness, along which creases, and which pieces it
/// joins again.
struct MMGRASP_EXPORT MeshSegmentationOptions {
  ShapeDiameterOptions diameter;
  int max_clusters = 8;    ///< Most Gaussians over the logarithms of the diameters; in [1, 32].
  double smoothing = 0.3;  ///< What a border between clusters costs beside faces in the wrong one; >= 0.
  double crease = 0.6;     ///< Inward creases of more, sharp or rounded over min_size, part segments [rad]; in (0, pi).
  double min_size = 0.02;  ///< Narrower segments join a neighbour, as a share of the mesh's diagonal; in (0, 0.5).
  double convexity = 0.05;     ///< Segments join when their hull has at most this share of the smaller one's volume
                               ///< that belongs to neither; >= 0.
  bool smooth_threads = true;  ///< Screw threads count as the cylinder through their crests.
  int faces = 20000;           ///< Larger faces are cut until there are about so many, for the work alone; in [1, 1e6].
  unsigned seed = 1;           ///< Same seed, same segments.
  void check() const;          ///< Throws InvalidInput naming field, value and rule.
};

/// A screw thread: a surface that keeps its place when it turns around an axis and moves along it.
struct MMGRASP_EXPORT ScrewThread {
  Pose T_mesh_thread = Pose::Identity();     ///< z along the axis, origin at the middle of the thread.
  double pitch = 0;                          ///< Along the axis in one turn [m]; positive: right-handed.
  double root_radius = 0, crest_radius = 0;  ///< [m]; the crest is the smaller one in a nut.
  double length = 0;                         ///< Along the axis [m].
  std::vector<int> faces;                    ///< Ascending.
};

/// A piece of a mesh's surface that bounds one simple body of the part: its shaft, its flange, its head.
struct MMGRASP_EXPORT MeshSegment {
  std::vector<int> faces;  ///< Indices of the mesh's faces, ascending.
  double area = 0;         ///< [m^2]
  double diameter = 0;     ///< Median of its faces' shape diameters by area [m].
  bool threaded = false;   ///< More than a tenth of its area belongs to a screw thread: not to be grasped there.
};

/// A mesh divided into segments, with the thickness measured at each face and the screw threads found.
struct MMGRASP_EXPORT MeshSegmentation {
  Outcome outcome = Outcome::solved;  ///< Solved, or stopped; then the rest is empty.
  std::vector<int> labels;            ///< Segment of each face of the mesh.
  std::vector<double> diameters;      ///< Shape diameter of each face [m]; 0 where unknown.
  std::vector<MeshSegment> segments;  ///< Largest area first.
  std::vector<ScrewThread> threads;   ///< Largest first.
  int clusters = 0;                   ///< Gaussians that the data called for.
  bool turned = false;                ///< The mesh was inside out (open ones may be) and its faces were turned.
};

/// Cuts the surface of a mechanical part into the simple bodies that it is composed of (P1, section 5.1): faces are
/// clustered by shape diameter (Gaussian mixture; minimum cuts over the edges), parted where the surface bends inwards,
/// and joined again where the hull of two segments is no more than the two. Inner walls (holes, bores, grooves'
/// sides) go with the outer wall behind them. An open mesh whose faces enclose a negative volume around its middle
/// counts as inside out. Throws InvalidInput for a mesh without area or with more than 10 million triangles.
MMGRASP_EXPORT MeshSegmentation segment_mesh(const TriangleMesh& mesh, const MeshSegmentationOptions& options = {},
                                             const Monitor& monitor = {});

}  // namespace mmgrasp
