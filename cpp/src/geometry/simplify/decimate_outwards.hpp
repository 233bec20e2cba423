#pragma once

#include <memory>

#include "mmgrasp/geometry/mesh.hpp"

namespace mmgrasp::detail {

/// A closed mesh with fewer triangles that contains a closed one. Edges are collapsed, cheapest in added volume first,
/// each to a point in front of all triangles around it and at most `reach` from the given mesh. The tetrahedra between
/// that point and those triangles are then all turned outwards: the winding number falls nowhere, so what was inside
/// stays inside. Empty when the result is no closed mesh or holds no fewer triangles.
std::shared_ptr<const TriangleMesh> decimate_outwards(const TriangleMesh& mesh, double reach);

}  // namespace mmgrasp::detail
