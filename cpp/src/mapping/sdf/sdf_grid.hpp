#pragma once

// Storage of a ProbabilisticSdf: blocks of voxels in a hash table.

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include "mapping/sdf/key_frame.hpp"
#include "mmgrasp/mapping/probabilistic_sdf.hpp"

namespace mmgrasp::detail {

constexpr int kBlockSide = 8;                                       // voxels along an edge of a block
constexpr int kBlockVoxels = kBlockSide * kBlockSide * kBlockSide;  // x runs fastest
constexpr int kMostBlocks = (1 << 20) - 8;                          // from the origin along an axis

/// The largest whole number that is not above a value of the size of an int; std::floor is a call on old processors.
inline int floor_of(double value) {
  const int towards_zero = static_cast<int>(value);
  return towards_zero - (value < towards_zero);
}

/// Has the cache fetch what is read soon: many such loads are under way at once. A load, since processors drop
/// prefetches while many are under way, and compilers drop functions that do nothing but prefetch.
inline void fetch(const void* at) {
  static_cast<void>(*static_cast<const volatile char*>(at));
}

/// Place of a block: its first voxel is 8 times this, voxel i lies at i * SdfOptions::voxel.
struct BlockKey {
  int x = 0, y = 0, z = 0;
  std::uint64_t packed() const {
    const auto field = [](int value) { return static_cast<std::uint64_t>(value + (1 << 20)); };
    return field(x) << 42 | field(y) << 21 | field(z);
  }
  static BlockKey unpack(std::uint64_t packed) {
    const auto field = [](std::uint64_t value) { return static_cast<int>(value & 0x1fffff) - (1 << 20); };
    return {field(packed >> 42), field(packed >> 21), field(packed)};
  }
  bool operator==(const BlockKey& other) const { return x == other.x && y == other.y && z == other.z; }
};

/// What one layer knows of a block. The sums are over the updates of all its voxels.
struct alignas(64) VoxelBlock {
  /// A row of voxels along x is a line of the cache: eight means of the signed distance [m], then their weights, which
  /// are 1 / variance without the systematic error [1 / m^2]; 0: never near a surface.
  float rows[kBlockSide * kBlockSide][2 * kBlockSide] = {};
  std::uint8_t near[kBlockVoxels] = {};  // frames that saw it near a surface; 255: at least
  std::uint8_t free[kBlockVoxels] = {};  // frames that looked through it since then; 255: at least
  bool looked_through = false;           // some of `free` are not zero

  float mean(int voxel) const { return rows[voxel >> 3][voxel & 7]; }
  float weight(int voxel) const { return rows[voxel >> 3][kBlockSide + (voxel & 7)]; }
  bool carved(int voxel) const { return looked_through && mean(voxel) < 0 && free[voxel] > near[voxel]; }
  double sum_weight = 0;
  double sum_correlation[3] = {0, 0, 0};  // weight times the correlation of errors of neighbours along x, y, z
  double sum_systematic = 0;              // weight times the systematic standard deviation

  float systematic_variance() const {
    const double sigma = sum_weight > 0 ? sum_systematic / sum_weight : 0;
    return static_cast<float>(sigma * sigma);
  }
};

/// Open addressing from packed keys to numbers >= 0; nothing is ever removed.
class KeyTable {
 public:
  int find(std::uint64_t key) const {
    if (slots_.empty()) return -1;
    for (std::size_t at = hash(key) & mask_;; at = (at + 1) & mask_) {
      const Slot& slot = slots_[at];
      if (slot.value < 0) return -1;
      if (slot.key == key) return slot.value;
    }
  }
  /// Has the cache fetch what find() will read first.
  void fetch(std::uint64_t key) const {
    if (!slots_.empty()) detail::fetch(&slots_[hash(key) & mask_]);
  }
  /// The value that is there, or `value`, now there.
  int insert(std::uint64_t key, int value);
  std::size_t size() const { return size_; }
  std::size_t bytes() const { return slots_.size() * sizeof(Slot); }

 private:
  struct Slot {
    std::uint64_t key = 0;
    int value = -1;
  };
  static std::size_t hash(std::uint64_t key) {
    key *= 0x9e3779b97f4a7c15ull;
    return key ^ (key >> 32);
  }
  void grow();

  std::vector<Slot> slots_;
  std::size_t mask_ = 0, size_ = 0;
};

/// A bit for each of 8 x 8 x 8 blocks, by which rays skip empty space.
using BlockMask = std::array<std::uint64_t, kBlockSide>;  // [z], bit 8 y + x

class CrossingCells;
struct FramePlanes;

struct SdfGrid {
  explicit SdfGrid(const SdfOptions& chosen) : options(chosen) {}
  SdfGrid(const SdfGrid& other);
  SdfGrid& operator=(const SdfGrid&) = delete;

  /// A copy of the blocks that the box [m] touches when it is grown by a voxel.
  std::shared_ptr<SdfGrid> cropped(const Eigen::AlignedBox3d& box) const;
  int find(const BlockKey& key) const { return table.find(key.packed()); }
  /// Box around a block's voxels [m].
  Eigen::AlignedBox3d box_of(const BlockKey& key) const;
  /// Adds an empty block of no layer.
  int add(const BlockKey& key);
  /// The camera's layer: the common one without a systematic error; as many as there are layers: it is new.
  int find_layer(const DepthCamera& camera) const;
  /// The same, camera and layer added when new.
  int layer_of(const DepthCamera& camera);
  /// Throws InvalidInput when another camera has this name.
  void check_camera(const DepthCamera& camera) const;
  void update_correlation(int block);
  /// Cells that the surface crosses, which rays look for; kept until the grid changes. Safe for several threads.
  std::shared_ptr<CrossingCells> crossing_cells() const;
  /// Must be called before the grid changes.
  void forget_crossing_cells();
  std::size_t bytes() const;

  SdfOptions options;
  std::vector<DepthCamera> cameras;
  std::vector<int> camera_layer;
  int frames = 0;
  KeyFrame key_frame;

  KeyTable table;
  std::vector<BlockKey> keys;
  Eigen::AlignedBox3d bounds;  ///< Box around all voxels [m]; for rays, however few at a time.
  std::vector<std::vector<std::unique_ptr<VoxelBlock>>> layers;  ///< [layer][block]; null where it saw nothing.
  /// Correlation of the errors of neighbouring voxels along x, y, z, over all layers.
  std::vector<std::array<float, 3>> correlation;
  KeyTable mask_table;
  std::vector<BlockMask> masks;
  std::shared_ptr<FramePlanes> frame_planes;  ///< The last frame's, for their memory; not copied.

 private:
  mutable std::mutex crossing_mutex_;
  mutable std::shared_ptr<CrossingCells> crossing_;
};

}  // namespace mmgrasp::detail
