#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/geometry/mesh.hpp"

namespace mmgrasp::detail {

/// What was wrong with triangles as they were given, and was mended where it could be.
struct MeshFaults {
  int repeated_triangles = 0;  ///< Stored twice: one of each was left out.
  int turned_triangles = 0;    ///< They looked inwards, or another way than their neighbours, and were turned.
  int enclosed_bodies = 0;     ///< Wholly within the material of others: left out.
  bool inside_out = false;     ///< All faces looked inwards; those of an open mesh do so still.
};

/// As load_mesh() and make_mesh(), with what was wrong.
MMGRASP_EXPORT std::shared_ptr<const TriangleMesh> load_mesh(const std::string& path, const Eigen::Vector3d& scale,
                                                             MeshFaults& faults);
MMGRASP_EXPORT std::shared_ptr<const TriangleMesh> make_mesh(std::vector<Eigen::Vector3d> vertices,
                                                             std::vector<std::array<int, 3>> triangles,
                                                             MeshFaults& faults);

}  // namespace mmgrasp::detail
