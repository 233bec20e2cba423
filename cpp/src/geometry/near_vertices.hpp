#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace mmgrasp::detail {

/// How far off rounding to single precision may put each vertex [m]: four units in the last place of the largest
/// coordinate of the triangles that meet there (a corner in the origin was turned with the others), but no more than a
/// thousandth of their shortest edge.
std::vector<double> roundings(const std::vector<Eigen::Vector3d>& vertices,
                              const std::vector<std::array<int, 3>>& triangles);

/// For each vertex the index of the one that it is the same as, to within the smaller one of both roundings: one of
/// lower index, or itself. Only the `candidates`, distinct indices in rising order, are compared.
std::vector<int> near_vertices(const std::vector<Eigen::Vector3d>& vertices, const std::vector<double>& roundings,
                               const std::vector<int>& candidates);

}  // namespace mmgrasp::detail
