#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"

namespace mmgrasp {

/// Indexed triangles [m]: a solid when closed, else a surface. Immutable once shared (`std::shared_ptr<const
/// TriangleMesh>`).
///
///     const auto mesh = load_mesh("bracket.stl");
///     if (!mesh->closed) std::cout << mesh->source << " is open: points inside it are free\n";
struct MMGRASP_EXPORT TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<int, 3>> triangles;
  /// Every edge is shared by two triangles in opposite directions, or by several such pairs where solids touch
  /// (counting slivers without area, which are then dropped), and the volume is positive: a solid. Else a surface.
  bool closed = false;
  bool convex = false;  ///< Closed and equal to its hull: may be treated as a convex polytope.
  std::string source;   ///< File it came from, or empty.
};

/// What the loader found and did, reported to the user by `mmgrasp check`.
struct MMGRASP_EXPORT MeshReport {
  std::string path;
  int vertices_read = 0;
  int vertices_merged = 0;       ///< Removed because they coincide with another one.
  int degenerate_triangles = 0;  ///< Removed: two equal corners, zero area, or stored twice.
  int triangles = 0;             ///< Kept.
  bool closed = false;
  bool convex = false;
  std::string chosen = "mesh";  ///< What stands in for it: "mesh", "hull", "box", ... (geometry/simplify_mesh.hpp).
  int triangles_saved = 0;      ///< Triangles that collision checks need not look at any more.
  double deviation = 0;         ///< No point of what was chosen lies farther than this from the mesh [m].
};

/// Reads STL, OBJ, PLY or DAE; merges equal vertices (and those of seams that are equal to single precision, where that
/// makes a solid), drops degenerate triangles, orients a closed mesh outwards (cavities inwards), faces of an open one
/// as neighbours. `scale` multiplies per axis. Files without a unit count as metres; a DAE's unit and node transforms
/// count, its up axis does not: URDF tools show it as it stands. Throws IoError naming the file (and line, if any) when
/// it is missing, truncated, empty, no mesh or holds a non-finite number; InvalidInput for a bad scale.
MMGRASP_EXPORT std::shared_ptr<const TriangleMesh> load_mesh(const std::string& path,
                                                             const Eigen::Vector3d& scale = Eigen::Vector3d::Ones(),
                                                             MeshReport* report = nullptr);

/// Builds a mesh from raw arrays with the same cleaning as load_mesh. Throws InvalidInput on bad indices or NaN.
MMGRASP_EXPORT std::shared_ptr<const TriangleMesh> make_mesh(std::vector<Eigen::Vector3d> vertices,
                                                             std::vector<std::array<int, 3>> triangles,
                                                             const std::string& source = "",
                                                             MeshReport* report = nullptr);

/// Convex hull, closed and convex. Throws InvalidInput for fewer than four points or all in one plane.
MMGRASP_EXPORT std::shared_ptr<const TriangleMesh> convex_hull(const std::vector<Eigen::Vector3d>& points);

/// Signed volume by the divergence theorem [m^3]; positive for a closed mesh oriented outwards.
MMGRASP_EXPORT double mesh_volume(const TriangleMesh& mesh);

/// True when the point lies inside a closed mesh (winding number along a ray of a fixed generic direction, so
/// overlapping shells count once and cavities are empty). False for open meshes.
MMGRASP_EXPORT bool mesh_contains(const TriangleMesh& mesh, const Eigen::Vector3d& point);

}  // namespace mmgrasp
