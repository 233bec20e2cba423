#pragma once

#include <cstdint>
#include <vector>

#include "mmgrasp/task/base_sequence.hpp"

namespace mmgrasp::detail {

/// The same for a plain bitmap of unit cells, row by row; lengths and `tolerance` in cells.
InscribedCircle inscribed_circle_in_cells(int nx, int ny, const std::vector<std::uint8_t>& cells, double tolerance);

}  // namespace mmgrasp::detail
