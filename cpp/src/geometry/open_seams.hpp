#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace mmgrasp::detail {

/// For each vertex the one that stands for it once seams are closed: vertices at the border of a surface that are the
/// same to within rounding to single precision (geometry/near_vertices). Empty: there are none.
std::vector<int> joined_at_seams(const std::vector<Eigen::Vector3d>& vertices,
                                 const std::vector<std::array<int, 3>>& triangles);

/// Which shells of a closed, consistently oriented mesh are about as thin as its vertices are rounded: sheets that were
/// stored from both sides, and no solids.
std::vector<bool> thin_shells(const std::vector<Eigen::Vector3d>& vertices,
                              const std::vector<std::array<int, 3>>& triangles);

}  // namespace mmgrasp::detail
