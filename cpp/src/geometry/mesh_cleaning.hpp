#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "mmgrasp/geometry/detail/mesh_faults.hpp"
#include "mmgrasp/geometry/mesh.hpp"

namespace mmgrasp::detail {

/// What a file or a caller says, before any cleaning.
struct RawMesh {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<int, 3>> triangles;
};

/// Merges equal vertices (where that leaves a solid open, those at its seams that are equal to single precision, too),
/// drops triangles without an area and unused vertices, and finds out whether the mesh is closed
/// and convex. Faces of an open one that look another way than their neighbours are turned, copies dropped. Input is
/// finite and its indices are in range.
std::shared_ptr<const TriangleMesh> clean_mesh(RawMesh raw, const std::string& source, MeshReport* report,
                                               MeshFaults* faults = nullptr);

}  // namespace mmgrasp::detail
