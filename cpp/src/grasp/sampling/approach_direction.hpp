#pragma once

#include <Eigen/Core>
#include <optional>

#include "mmgrasp/geometry/shape.hpp"

namespace mmgrasp::detail {

/// The direction across a closing axis (unit) next to the wanted one (unit); none where the axis is not straight across
/// that, to within kStraightApproach.
std::optional<Eigen::Vector3d> straight_across(const Eigen::Vector3d& axis, const Eigen::Vector3d& wanted);

/// Whether none of a shape's own faces and axes is straight along or across a unit vector in the shape's frame: closed
/// forms say nothing of it there. False for shapes that look alike from everywhere, or are none of the round and boxes.
bool lies_askew(const Shape& shape, const Eigen::Vector3d& direction);

}  // namespace mmgrasp::detail
