#pragma once

#include "mapping/sdf/sdf_grid.hpp"

namespace mmgrasp::detail {

/// ProbabilisticSdf::cast_rays() for the columns `first` to `last` - 1, into the same entries of `out`.
void cast_rays(const SdfGrid& grid, CrossingCells& crossing, const Eigen::Ref<const Eigen::Matrix3Xd>& origins,
               const Eigen::Ref<const Eigen::Matrix3Xd>& directions, Eigen::Index first, Eigen::Index last,
               SdfHits& out);

}  // namespace mmgrasp::detail
