#pragma once

#include "mapping/sdf/sdf_grid.hpp"

namespace mmgrasp::detail {

/// ProbabilisticSdf::query() for the columns `first` to `last` - 1 of `points`, into the same entries of `out`.
void query_points(const SdfGrid& grid, const Eigen::Ref<const Eigen::Matrix3Xd>& points, Eigen::Index first,
                  Eigen::Index last, SdfValues& out);

}  // namespace mmgrasp::detail
