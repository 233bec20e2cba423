#pragma once

#include <memory>

#include "collision/broad/sphere_cover.hpp"
#include "collision/narrow/solid.hpp"
#include "mmgrasp/geometry/shape.hpp"

namespace mmgrasp::detail {

/// make_solid, kept as long as the mesh or cloud it was made from lives: a new checker for a changed world is then
/// cheap.
std::shared_ptr<const Solid> shared_solid(const Shape& shape, double padding);

/// The bounding volumes of a solid, kept likewise; those of primitives for some time.
std::shared_ptr<const BoundingVolumes> shared_bounds(const Solid& solid, const Shape& shape);

}  // namespace mmgrasp::detail
