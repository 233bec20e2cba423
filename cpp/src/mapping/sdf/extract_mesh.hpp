#pragma once

#include "mapping/sdf/sdf_grid.hpp"

namespace mmgrasp::detail {

/// The zero level with the standard deviation at each vertex; blocks in the order of their keys.
SdfMesh extract_mesh(const SdfGrid& grid);

}  // namespace mmgrasp::detail
