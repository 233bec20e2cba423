#pragma once

#include <numeric>
#include <vector>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/geometry/mesh.hpp"

namespace mmgrasp::detail {

/// The faces given, or all of the mesh where none are. Throws InvalidInput for numbers that are no face's.
inline std::vector<int> faces_or_all(const TriangleMesh& mesh, std::vector<int> faces) {
  const int count = static_cast<int>(mesh.triangles.size());
  for (const int f : faces) require(f >= 0 && f < count, "faces", f, "must be numbers of the mesh's triangles");
  if (!faces.empty()) return faces;
  faces.resize(count);
  std::iota(faces.begin(), faces.end(), 0);
  return faces;
}

}  // namespace mmgrasp::detail
