#include "mapping/sdf/crossing_cells.hpp"

#include <array>

namespace mmgrasp::detail {
namespace {

constexpr int kSide = kBlockSide + 1;  // a block's voxels and the first of the next ones

}  // namespace

CrossingCells::Known CrossingCells::find(int block, const BlockKey& key, SdfSampler& sampler) {
  // Bits of corners along x, by y and z.
  std::array<std::array<std::uint32_t, kSide>, kSide> known{}, behind{};
  for (int z = 0; z < kSide; ++z) {
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        const bool inside = x < kBlockSide && y < kBlockSide && z < kBlockSide;
        const Node node = inside ? sampler.node(block, (z << 6) + (y << 3) + x)
                                 : sampler.node_at(8 * key.x + x, 8 * key.y + y, 8 * key.z + z);
        known[z][y] |= static_cast<std::uint32_t>(node.seen != Seen::nothing) << x;
        behind[z][y] |= static_cast<std::uint32_t>(node.seen != Seen::nothing && node.mean <= 0) << x;
      }
    }
  }
  std::uint64_t some = 0;
  for (int z = 0; z < kBlockSide; ++z) {
    std::uint64_t word = 0;
    for (int y = 0; y < kBlockSide; ++y) {
      const std::uint32_t all = known[z][y] & known[z][y + 1] & known[z + 1][y] & known[z + 1][y + 1];
      const std::uint32_t any = behind[z][y] | behind[z][y + 1] | behind[z + 1][y] | behind[z + 1][y + 1];
      const std::uint64_t row = (all & all >> 1) & (any | any >> 1) & 0xff;
      word |= row << (8 * y);
    }
    some |= word;
    words(block)[z].store(word, std::memory_order_relaxed);
  }
  const Known found = some != 0 ? kSome : kNone;
  known_[block].store(found, std::memory_order_release);
  return found;
}

}  // namespace mmgrasp::detail
