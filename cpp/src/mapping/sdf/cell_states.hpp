#pragma once

// The lattice's cells of eight neighbouring voxels: which may hold a surface, or what lies behind one.

#include <vector>

#include "mapping/sdf/sdf_grid.hpp"

namespace mmgrasp::detail {

/// Cell (x, y, z) of a block lies between its voxel (x, y, z) and voxel (x + 1, y + 1, z + 1), which may belong to the
/// next blocks. A bit a cell, as in BlockMask.
struct CellBlock {
  BlockKey key;
  BlockMask occupied{};  ///< mean - sigmas * sigma may be zero or less.
  BlockMask clear{};     ///< All eight voxels are known, and it is positive in the whole cell.
};

/// Every block with a cell that has a known corner.
struct CellBlocks {
  KeyTable table;
  std::vector<CellBlock> blocks;

  int find(const BlockKey& key) const { return table.find(key.packed()); }
};

/// The cells of a map. A cell is occupied when mean - sigmas * sigma, as SdfSampler interpolates it, may be zero or
/// less somewhere in it. Of a cell with unknown corners the known ones decide.
CellBlocks cell_states(const SdfGrid& grid, double sigmas);

}  // namespace mmgrasp::detail
