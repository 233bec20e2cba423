#pragma once

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/geometry/mesh.hpp"

namespace mmgrasp::detail {

/// How many bodies a mesh is of that neither touch nor stand in each other. A cavity is its solid's, what lies loose in
/// a cavity is a body. Shells of open meshes are bodies of their own only where their bounds are apart.
MMGRASP_EXPORT int count_bodies(const TriangleMesh& mesh);

}  // namespace mmgrasp::detail
