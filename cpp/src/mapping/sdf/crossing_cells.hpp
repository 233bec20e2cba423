#pragma once

// Which cells between voxels a surface can cross: rays look at no others.

#include <atomic>
#include <vector>

#include "mapping/sdf/sdf_sampler.hpp"

namespace mmgrasp::detail {

/// Found block by block when a ray first comes by, for a grid that does not change. Several threads may ask at once:
/// who comes second finds the same.
class CrossingCells {
 public:
  explicit CrossingCells(std::size_t blocks) : words_(kBlockSide * blocks), known_(blocks) {}

  /// Flags of a block's cells, [z], bit 8 y + x, of those whose eight corners are known and one of them not in front of
  /// the surface; null: there are none. A cell belongs to the block of its lowest corner.
  const std::atomic<std::uint64_t>* of(int block, const BlockKey& key, SdfSampler& sampler) {
    std::uint8_t known = known_[block].load(std::memory_order_acquire);
    if (known == kUnknown) known = find(block, key, sampler);
    return known == kSome ? words(block) : nullptr;
  }

 private:
  enum Known : std::uint8_t { kUnknown, kNone, kSome };

  std::atomic<std::uint64_t>* words(int block) { return &words_[kBlockSide * static_cast<std::size_t>(block)]; }
  Known find(int block, const BlockKey& key, SdfSampler& sampler);

  std::vector<std::atomic<std::uint64_t>> words_;
  std::vector<std::atomic<std::uint8_t>> known_;
};

}  // namespace mmgrasp::detail
