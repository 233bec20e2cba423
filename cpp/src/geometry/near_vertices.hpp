#pragma once

#include <Eigen/Core>
#include <vector>

namespace mmgrasp::detail {

/// How far off rounding to single precision may put a vertex [m]: from 2 to 4 units in the last place of its own
/// largest coordinate, so that two roundings of one place, turned or shifted in between, lie within it of each other.
double rounding_of(const Eigen::Vector3d& vertex);

/// For each vertex the index of the one that it is the same as to within rounding_of(): one of lower index, or itself.
/// Only the `candidates`, distinct indices in rising order, are compared.
std::vector<int> near_vertices(const std::vector<Eigen::Vector3d>& vertices, const std::vector<int>& candidates);

}  // namespace mmgrasp::detail
