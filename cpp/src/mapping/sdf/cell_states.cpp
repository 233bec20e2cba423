#include "mapping/sdf/cell_states.hpp"

#include <algorithm>
#include <cmath>

#include "mapping/sdf/sdf_sampler.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/parallel.hpp"

namespace mmgrasp::detail {
namespace {

constexpr std::size_t kBlocksOfItem = 16;
/// Voxels along an edge of what is read for a block's cells: their corners and two more on either side.
constexpr int kPad = 2, kNodes = kBlockSide + 1 + 2 * kPad;
/// Near sharp edges and corners the map is rounded off, which sigma does not tell: by less than this [voxels], measured
/// in tests/cpp/mapping/test_obstacle_cells.cpp.
constexpr double kEdgeRounding = 0.5;

/// What a corner says of the surface's distance.
struct Corner {
  float mean = 0;
  float variance = 0;  // with the systematic part
  float low = 0;       // mean - sigmas * sigma
  Seen seen = Seen::nothing;
  bool looked_through = false;  // by more frames than saw it near a surface
};

/// Whether mean - sigmas * sigma is positive wherever mean and variance are interpolated between these corners with
/// weights that sum to one. -sqrt(v) is the largest of -(v / s + s) / 2 over s > 0, so any s gives a lower bound that
/// is linear in the weights and hence least at a corner; the best s is near a corner's sigma.
bool surely_positive(const Corner* corners, int count, float sigmas) {
  for (int j = 0; j < count; ++j) {
    const float s = std::sqrt(corners[j].variance);
    if (!(s > 0)) continue;
    float least = static_cast<float>(kInfinity);
    for (int i = 0; i < count; ++i) {
      least = std::min(least, corners[i].mean - 0.5f * sigmas * (corners[i].variance / s + s));
    }
    if (least > 0) return true;
  }
  return false;
}

/// Tells occupied cells, in which mean - sigmas * sigma may be zero or less, from clear ones, in which it never is.
class CellStates {
 public:
  CellStates(const SdfGrid& grid, double sigmas)
      : grid_(grid),
        sigmas_(static_cast<float>(sigmas)),
        rounding_(static_cast<float>(kEdgeRounding * grid.options.voxel)) {}

  CellBlocks run() {
    std::vector<CellBlock> blocks;
    KeyTable table;
    for (const BlockKey& key : grid_.keys) {
      for (int k = 0; k < 27; ++k) {
        const BlockKey at{key.x + k % 3 - 1, key.y + k / 3 % 3 - 1, key.z + k / 9 - 1};
        const int index = static_cast<int>(blocks.size());
        if (table.insert(at.packed(), index) == index) blocks.push_back({at});
      }
    }
    const std::size_t items = (blocks.size() + kBlocksOfItem - 1) / kBlocksOfItem;
    parallel_for(items, grid_.options.threads, [&](std::size_t item, int) {
      std::vector<Corner> voxels, filled;
      const std::size_t last = std::min(blocks.size(), (item + 1) * kBlocksOfItem);
      for (std::size_t i = item * kBlocksOfItem; i < last; ++i) {
        if (!read(blocks[i].key, voxels)) continue;
        drop_ghosts(voxels);
        fill(voxels, filled);
        judge(voxels, filled, blocks[i]);
      }
    });
    CellBlocks out;
    for (const CellBlock& block : blocks) {
      if (block.occupied == BlockMask{} && block.clear == BlockMask{}) continue;
      out.table.insert(block.key.packed(), static_cast<int>(out.blocks.size()));
      out.blocks.push_back(block);
    }
    return out;
  }

 private:
  static int at(int x, int y, int z) { return ((z + kPad) * kNodes + y + kPad) * kNodes + x + kPad; }

  /// Voxels -2 to 10 along each axis from the block's first; whether one of them is known.
  bool read(const BlockKey& key, std::vector<Corner>& voxels) const {
    voxels.assign(kNodes * kNodes * kNodes, {});
    const SdfSampler sampler(grid_);
    static constexpr int kFirst[3] = {-kPad, 0, kBlockSide}, kLast[3] = {-1, kBlockSide - 1, kBlockSide + kPad};
    bool any = false;
    for (int k = 0; k < 27; ++k) {
      const int part[3] = {k % 3, k / 3 % 3, k / 9};
      const int block = grid_.find({key.x + part[0] - 1, key.y + part[1] - 1, key.z + part[2] - 1});
      if (block < 0) continue;
      for (int z = kFirst[part[2]]; z <= kLast[part[2]]; ++z) {
        for (int y = kFirst[part[1]]; y <= kLast[part[1]]; ++y) {
          for (int x = kFirst[part[0]]; x <= kLast[part[0]]; ++x) {
            const Node node = sampler.node(block, ((z & 7) << 6) + ((y & 7) << 3) + (x & 7));
            if (node.seen == Seen::nothing) continue;
            any = true;
            Corner& corner = voxels[at(x, y, z)];
            corner.mean = node.mean - rounding_;
            corner.variance = node.variance + node.systematic;
            corner.low = corner.mean - sigmas_ * std::sqrt(corner.variance);
            corner.seen = node.seen;
            corner.looked_through = node.looked_through;
          }
        }
      }
    }
    return any;
  }

  /// Voxels with a small positive mean stay in front of what moved away. Where more frames looked through a voxel
  /// than saw something in it, it belongs to a surface only beside a voxel nearer to that surface, or behind it, that
  /// they did not look through; others are dropped.
  static void drop_ghosts(std::vector<Corner>& voxels) {
    for (int z = -1; z <= kBlockSide + 1; ++z) {
      for (int y = -1; y <= kBlockSide + 1; ++y) {
        for (int x = -1; x <= kBlockSide + 1; ++x) {
          Corner& corner = voxels[at(x, y, z)];
          if (corner.seen != Seen::surface || !corner.looked_through) continue;
          bool backed = false;
          for (int k = 0; k < 27 && !backed; ++k) {
            const Corner& beside = voxels[at(x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1)];
            backed = beside.seen == Seen::surface && !beside.looked_through && beside.mean < corner.mean;
          }
          if (!backed) corner.seen = Seen::free;
        }
      }
    }
  }

  /// At its rim a surface goes on for a part of a voxel: an unknown voxel takes what says least distance among the six
  /// around.
  static void fill(const std::vector<Corner>& voxels, std::vector<Corner>& filled) {
    static constexpr int kSteps[6] = {1, -1, kNodes, -kNodes, kNodes * kNodes, -kNodes * kNodes};
    filled = voxels;
    for (int z = 0; z <= kBlockSide; ++z) {
      for (int y = 0; y <= kBlockSide; ++y) {
        for (int x = 0; x <= kBlockSide; ++x) {
          Corner& corner = filled[at(x, y, z)];
          if (corner.seen != Seen::nothing) continue;
          for (const int step : kSteps) {
            const Corner& beside = voxels[at(x, y, z) + step];
            if (beside.seen != Seen::surface) continue;
            if (corner.seen == Seen::nothing || beside.low < corner.low) corner = beside;
          }
        }
      }
    }
  }

  void judge(const std::vector<Corner>& voxels, const std::vector<Corner>& filled, CellBlock& block) const {
    for (int cell = 0; cell < kBlockVoxels; ++cell) {
      const int first = at(cell & 7, cell >> 3 & 7, cell >> 6);
      Corner near[8];
      int surfaces = 0, known = 0;
      bool negative = false;
      for (int k = 0; k < 8; ++k) {
        const int corner = first + (k & 1) + (k >> 1 & 1) * kNodes + (k >> 2) * kNodes * kNodes;
        known += voxels[corner].seen != Seen::nothing;
        // SdfSampler gives a corner that was looked through a larger mean and the variance of one near a surface.
        if (filled[corner].seen != Seen::surface) continue;
        negative = negative || filled[corner].low <= 0;
        near[surfaces++] = filled[corner];
      }
      const std::uint64_t bit = std::uint64_t{1} << (cell & 63);
      const bool positive = surfaces == 0 || (!negative && surely_positive(near, surfaces, sigmas_));
      if (!positive) block.occupied[cell >> 6] |= bit;
      if (positive && known == 8) block.clear[cell >> 6] |= bit;
    }
  }

  const SdfGrid& grid_;
  const float sigmas_, rounding_;
};

}  // namespace

CellBlocks cell_states(const SdfGrid& grid, double sigmas) {
  return CellStates(grid, sigmas).run();
}

}  // namespace mmgrasp::detail
