#pragma once

#include "mapping/sdf/sdf_grid.hpp"

namespace mmgrasp::detail {

/// ProbabilisticSdf::cast_rays() for the columns `first` to `last` - 1, into the same entries of `out`, which says
/// that they do not hit.
void cast_rays(const SdfGrid& grid, CrossingCells& crossing, const Eigen::Matrix3Xd& origins,
               const Eigen::Matrix3Xd& directions, Eigen::Index first, Eigen::Index last, SdfHits& out);

}  // namespace mmgrasp::detail
