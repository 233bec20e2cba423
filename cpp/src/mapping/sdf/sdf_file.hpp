#pragma once

#include "mapping/sdf/sdf_grid.hpp"

namespace mmgrasp::detail {

/// docs/methods/mapping.md describes the format.
void write_sdf(const SdfGrid& grid, const std::string& path);
std::shared_ptr<SdfGrid> read_sdf(const std::string& path);

}  // namespace mmgrasp::detail
