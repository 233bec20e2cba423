#pragma once

#include "mapping/sdf/sdf_grid.hpp"

namespace mmgrasp::detail {

/// ProbabilisticSdf::integrate() on a grid; on an exception the grid is as it was.
IntegrationReport integrate_frame(SdfGrid& grid, DepthImage image, const DepthCamera& camera,
                                  const FrameUncertainty& uncertainty);

}  // namespace mmgrasp::detail
