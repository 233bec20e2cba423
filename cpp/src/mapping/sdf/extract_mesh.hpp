#pragma once

#include "mapping/sdf/sdf_grid.hpp"

namespace mmgrasp::detail {

/// The zero level with the standard deviation at each vertex; blocks in the order of their keys. With `within` that of
/// the cells between voxels alone that the box touches. Empty when the monitor ended it.
SdfMesh extract_mesh(const SdfGrid& grid, const Eigen::AlignedBox3d* within, const Monitor& monitor);

}  // namespace mmgrasp::detail
