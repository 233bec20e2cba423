#pragma once

// A block and those beyond its faces, edges and corner along x, y, z: the eight that a cell's corners can be in.

#include <cstdint>

#include "mapping/sdf/sdf_grid.hpp"

namespace mmgrasp::detail {

/// Looked up when first asked for, and kept until another block is entered. Not for several threads at once.
class BlockNeighbours {
 public:
  explicit BlockNeighbours(const SdfGrid& grid) : grid_(grid), single_(grid.layers.size() == 1) {}

  void enter(const BlockKey& key) {
    if (entered_ && key == key_) return;
    entered_ = true;
    key_ = key;
    known_ = 0;
  }
  /// Block beyond the entered one along x, y, z by the bits of `which`; negative: the grid has none.
  int index(int which) {
    if (!(known_ >> which & 1)) look_up(which);
    return index_[which];
  }
  /// Its voxels, in a grid of one layer; null where there are none.
  const VoxelBlock* voxels(int which) {
    if (!(known_ >> which & 1)) look_up(which);
    return voxels_[which];
  }

 private:
  void look_up(int which) {
    known_ |= 1u << which;
    index_[which] = grid_.find({key_.x + (which & 1), key_.y + (which >> 1 & 1), key_.z + (which >> 2)});
    voxels_[which] = single_ && index_[which] >= 0 ? grid_.layers[0][index_[which]].get() : nullptr;
  }

  const SdfGrid& grid_;
  const bool single_;
  bool entered_ = false;
  BlockKey key_;
  unsigned known_ = 0;
  int index_[8] = {};
  const VoxelBlock* voxels_[8] = {};
};

}  // namespace mmgrasp::detail
