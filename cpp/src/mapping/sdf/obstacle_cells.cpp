#include "mapping/sdf/obstacle_cells.hpp"

#include <algorithm>
#include <cmath>

#include "mapping/sdf/cell_states.hpp"
#include "mapping/sdf/enclosed_cells.hpp"
#include "mmgrasp/core/error.hpp"

namespace mmgrasp::detail {
namespace {

constexpr double kMostBlocksInBounds = 2e7;
/// Boxes of 8 blocks and more along an edge are merged from blocks so many times.
constexpr int kMostLevels = 20;

BlockMask all_cells() {
  BlockMask out;
  out.fill(~std::uint64_t{0});
  return out;
}

/// Collects leaves: single cells, and whole blocks merged eight to one as long as they are.
class Leaves {
 public:
  explicit Leaves(double voxel) : voxel_(voxel) {}

  void add(const BlockKey& key, const BlockMask& mask) {
    if (mask == all_cells()) {
      whole_.push_back(key);
      return;
    }
    const Eigen::Vector3d corner = kBlockSide * voxel_ * Eigen::Vector3d(key.x, key.y, key.z);
    for (int cell = 0; cell < kBlockVoxels; ++cell) {
      if (!(mask[cell >> 6] >> (cell & 63) & 1)) continue;
      cells_.push_back(corner + voxel_ * Eigen::Vector3d((cell & 7) + 0.5, (cell >> 3 & 7) + 0.5, (cell >> 6) + 0.5));
    }
  }

  std::vector<Voxels> take() {
    std::vector<Voxels> out;
    push(out, std::move(cells_), voxel_);
    std::vector<BlockKey> level = std::move(whole_);
    const auto order = [](const BlockKey& a, const BlockKey& b) { return a.packed() < b.packed(); };
    std::sort(level.begin(), level.end(), order);
    level.erase(std::unique(level.begin(), level.end()), level.end());
    double edge = kBlockSide * voxel_;
    for (int k = 0; !level.empty(); ++k, edge *= 2) {
      std::vector<BlockKey> above;
      std::vector<Eigen::Vector3d> centres;
      merge(level, k < kMostLevels, above, [&](const BlockKey& key) {
        centres.push_back(edge * Eigen::Vector3d(key.x + 0.5, key.y + 0.5, key.z + 0.5));
      });
      push(out, std::move(centres), edge);
      level = std::move(above);
    }
    return out;
  }

 private:
  /// Eight children of one parent become the parent; `keep` gets the others.
  template <typename Keep>
  static void merge(std::vector<BlockKey>& level, bool further, std::vector<BlockKey>& above, const Keep& keep) {
    const auto parent = [](const BlockKey& key) { return BlockKey{key.x >> 1, key.y >> 1, key.z >> 1}; };
    std::sort(level.begin(), level.end(), [&](const BlockKey& a, const BlockKey& b) {
      const std::uint64_t pa = parent(a).packed(), pb = parent(b).packed();
      return pa != pb ? pa < pb : a.packed() < b.packed();
    });
    for (std::size_t first = 0; first < level.size();) {
      std::size_t last = first + 1;
      while (last < level.size() && parent(level[last]) == parent(level[first])) ++last;
      if (further && last - first == 8) {
        above.push_back(parent(level[first]));
      } else {
        std::for_each(level.begin() + first, level.begin() + last, keep);
      }
      first = last;
    }
  }

  static void push(std::vector<Voxels>& out, std::vector<Eigen::Vector3d> centres, double edge) {
    if (centres.empty()) return;
    out.push_back({std::make_shared<const std::vector<Eigen::Vector3d>>(std::move(centres)), edge});
  }

  double voxel_;
  std::vector<Eigen::Vector3d> cells_;
  std::vector<BlockKey> whole_;
};

/// First and last cell that the bounds meet along each axis.
struct CellRange {
  int first[3], last[3];

  CellRange(const Eigen::AlignedBox3d& bounds, double voxel) {
    double blocks = 1;
    for (int k = 0; k < 3; ++k) {
      const double low = std::floor(bounds.min()[k] / voxel), high = std::ceil(bounds.max()[k] / voxel) - 1;
      require(low >= -8.0 * kMostBlocks && high < 8.0 * kMostBlocks, "bounds", bounds.sizes()[k],
              "reach farther from the origin than a map of this voxel can");
      first[k] = static_cast<int>(low);
      last[k] = std::max(first[k], static_cast<int>(high));
      blocks *= (last[k] >> 3) - (first[k] >> 3) + 1.0;
    }
    require(blocks <= kMostBlocksInBounds, "bounds", bounds.sizes().prod(),
            "hold more than 20 million blocks of 8 x 8 x 8 voxels [m^3]");
  }

  /// The cells of a block that lie in the range.
  BlockMask of(const BlockKey& key) const {
    const int origin[3] = {8 * key.x, 8 * key.y, 8 * key.z};
    BlockMask out{};
    for (int cell = 0; cell < kBlockVoxels; ++cell) {
      const int at[3] = {origin[0] + (cell & 7), origin[1] + (cell >> 3 & 7), origin[2] + (cell >> 6)};
      bool inside = true;
      for (int k = 0; k < 3; ++k) inside = inside && at[k] >= first[k] && at[k] <= last[k];
      if (inside) out[cell >> 6] |= std::uint64_t{1} << (cell & 63);
    }
    return out;
  }
};

/// What is not known to be clear within the bounds becomes occupied.
void fill_unknown(CellBlocks& cells, const CellRange& range, Leaves& leaves) {
  for (int z = range.first[2] >> 3; z <= range.last[2] >> 3; ++z) {
    for (int y = range.first[1] >> 3; y <= range.last[1] >> 3; ++y) {
      for (int x = range.first[0] >> 3; x <= range.last[0] >> 3; ++x) {
        const BlockKey key{x, y, z};
        const BlockMask inside = range.of(key);
        const int block = cells.find(key);
        if (block < 0) {
          leaves.add(key, inside);
          continue;
        }
        CellBlock& known = cells.blocks[block];
        for (int k = 0; k < kBlockSide; ++k) known.occupied[k] |= inside[k] & ~known.clear[k];
      }
    }
  }
}

}  // namespace

std::vector<Voxels> obstacle_cells(const SdfGrid& grid, const SdfObstacleOptions& options) {
  options.check();
  CellBlocks cells = cell_states(grid, options.sigmas);
  Leaves leaves(grid.options.voxel);
  const Eigen::AlignedBox3d bounds = options.bounds.isEmpty() ? grid.bounds : options.bounds;
  if (options.unknown == UnknownSpace::occupied && !bounds.isEmpty()) {
    fill_unknown(cells, CellRange(bounds, grid.options.voxel), leaves);
  }
  for (const BlockKey& key : fill_enclosed(cells)) leaves.add(key, all_cells());
  for (const CellBlock& block : cells.blocks) leaves.add(block.key, block.occupied);
  return leaves.take();
}

}  // namespace mmgrasp::detail
