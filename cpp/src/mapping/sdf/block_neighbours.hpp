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
  /// Looks up those of a set of bits in three steps, so that what each reads of many points is fetched at once.
  void fetch_slots(unsigned set) const {
    for_each(set, [&](int which) { grid_.table.fetch(key_of(which).packed()); });
  }
  void find_blocks(unsigned set) {
    for_each(set, [&](int which) {
      index_[which] = grid_.find(key_of(which));
      if (index_[which] < 0) return;
      for (const auto& layer : grid_.layers) fetch(&layer[index_[which]]);
    });
  }
  void find_voxels(unsigned set) {
    for_each(set, [&](int which) { voxels_[which] = voxels_of(index_[which]); });
    known_ |= set;
  }
  /// Calls visit(which) for each bit of a set.
  template <typename Visit>
  static void for_each(unsigned set, const Visit& visit) {
    for (; set != 0; set &= set - 1) visit(__builtin_ctz(set));
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
  BlockKey key_of(int which) const { return {key_.x + (which & 1), key_.y + (which >> 1 & 1), key_.z + (which >> 2)}; }
  const VoxelBlock* voxels_of(int index) const {
    return single_ && index >= 0 ? grid_.layers[0][index].get() : nullptr;
  }
  void look_up(int which) {
    known_ |= 1u << which;
    index_[which] = grid_.find(key_of(which));
    voxels_[which] = voxels_of(index_[which]);
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
