#pragma once

#include <Eigen/Core>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/geometry/mesh.hpp"

namespace mmgrasp {

/// A nearly plane piece of a surface (P1 5.3.3, planar clustering).
struct MMGRASP_EXPORT Facet {
  std::vector<int> faces;                             ///< Indices of the mesh's faces, ascending.
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< Outwards, weighted by area.
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();   ///< Centre of its area [m].
  double area = 0;                                    ///< [m^2]
};

/// Nearly plane pieces of a mesh, or of some of its faces (empty: all), largest first: each grows from the largest face
/// left over edges, as long as faces bend no more than `angle` [rad] from it.
MMGRASP_EXPORT std::vector<Facet> planar_facets(const TriangleMesh& mesh, const std::vector<int>& faces = {},
                                                double angle = 0.1);

}  // namespace mmgrasp
