#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

namespace mmgrasp::detail {

/// True when triangles enclose a negative volume with the middle of their bounds; a flat sheet encloses none.
bool faces_inwards(const std::vector<Eigen::Vector3d>& vertices, const std::vector<std::array<int, 3>>& triangles);

}  // namespace mmgrasp::detail
