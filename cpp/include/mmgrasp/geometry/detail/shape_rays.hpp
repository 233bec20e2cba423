#pragma once

#include <Eigen/Core>

#include "mmgrasp/geometry/shape.hpp"

namespace mmgrasp::detail {

/// Smallest t > 0 at which origin + t direction meets the surface of the shape (in the shape's own frame), or infinity.
/// For shapes in closed form: box, sphere, cylinder, capsule, plane. Infinity for the others.
double first_hit(const Shape& shape, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction);

}  // namespace mmgrasp::detail
