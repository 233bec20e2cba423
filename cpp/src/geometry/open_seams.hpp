#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace mmgrasp::detail {

/// For each vertex the one that stands for it once seams are closed: vertices at the border of a surface that are the
/// same to within rounding to single precision (geometry/near_vertices). Empty: there are none.
std::vector<int> joined_at_seams(const std::vector<Eigen::Vector3d>& vertices,
                                 const std::vector<std::array<int, 3>>& triangles);

/// Whether some shell of a closed, consistently oriented mesh is about as thin as its vertices are rounded: a sheet
/// that was stored from both sides, and no solid.
bool is_thin(const std::vector<Eigen::Vector3d>& vertices, const std::vector<std::array<int, 3>>& triangles);

}  // namespace mmgrasp::detail
