#pragma once

#include "mapping/sdf/crossing_cells.hpp"

namespace mmgrasp::detail {

/// First crossing of the zero level from the front along origin + t direction; NaN without one.
double first_crossing(const SdfGrid& grid, CrossingCells& crossing, SdfSampler& sampler, const Eigen::Vector3d& origin,
                      const Eigen::Vector3d& direction);

}  // namespace mmgrasp::detail
