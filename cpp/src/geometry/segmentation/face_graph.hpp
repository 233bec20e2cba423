#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "mmgrasp/geometry/mesh.hpp"

namespace mmgrasp::detail {

/// Two faces that share an edge.
struct FaceBorder {
  int first = 0, second = 0;
  double length = 0;  ///< Length of the shared edge [m].
  double bend = 0;    ///< Angle between the normals [rad]; positive where the solid is convex, negative in a crease.
  std::array<int, 2> vertices{};
};

/// The faces of a mesh with their neighbours. Edges of more than two faces join the faces in pairs, as they come.
struct FaceGraph {
  std::vector<Eigen::Vector3d> vertices, centres, normals;  ///< Normals are unit, or zero for a face without area.
  std::vector<std::array<int, 3>> faces;
  std::vector<double> areas;
  std::vector<int> parents;  ///< The face of the mesh that this one is a piece of.
  std::vector<FaceBorder> borders;
  std::vector<int> first_border, border_of;  ///< Borders of face f: border_of[first_border[f] .. first_border[f + 1]).
  double area = 0;                           ///< Area of all faces [m^2].

  int size() const { return static_cast<int>(faces.size()); }
  int other(int border, int face) const {
    return borders[border].first == face ? borders[border].second : borders[border].first;
  }
  /// Computes everything but vertices, faces and parents anew. `known`: normals of the mesh's faces where they are
  /// known better than by their corners, else zero; none: of no face.
  void measure(const std::vector<Eigen::Vector3d>& known = {});
  TriangleMesh mesh() const;
};

/// The faces of the mesh, cut at the middles of all edges longer than `longest` [m], again and again, the longest
/// first, until there are `most` faces. `known_normals`: as in FaceGraph::measure().
FaceGraph refined_faces(const TriangleMesh& mesh, double longest, std::size_t most,
                        const std::vector<Eigen::Vector3d>& known_normals = {});

}  // namespace mmgrasp::detail
