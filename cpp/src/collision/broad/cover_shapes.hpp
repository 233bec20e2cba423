#pragma once

#include "collision/broad/sphere_cover.hpp"
#include "mmgrasp/geometry/mesh.hpp"

namespace mmgrasp::detail {

/// Adds spheres that cover a mesh, or a primitive shape, to every level: the bounding box is cut into cells, and each
/// gets a sphere around its part of the body. `solid` was made of the mesh. Clouds and planes get none.
void cover_mesh(const TriangleMesh& mesh, const Solid& solid, CoverLevels& levels);
void cover_primitive(const Shape& shape, CoverLevels& levels);

}  // namespace mmgrasp::detail
