#pragma once

#include "mapping/sdf/cell_states.hpp"

namespace mmgrasp::detail {

/// Makes occupied what occupied cells enclose: cells from which no way through faces of cells leads out of the map, nor
/// to a clear cell (the inside of a room that was seen from within). Returns the keys of whole blocks without a cell in
/// `cells` that are enclosed, in order.
std::vector<BlockKey> fill_enclosed(CellBlocks& cells);

}  // namespace mmgrasp::detail
