#pragma once

#include <vector>

#include "mapping/sdf/sdf_grid.hpp"

namespace mmgrasp::detail {

/// See ProbabilisticSdf::obstacle_cells.
std::vector<Voxels> obstacle_cells(const SdfGrid& grid, const SdfObstacleOptions& options);

}  // namespace mmgrasp::detail
