#pragma once

// Reads a grid at voxels and between them.

#include <algorithm>
#include <cmath>

#include "mapping/sdf/block_neighbours.hpp"
#include "mapping/sdf/cell_values.hpp"
#include "mapping/sdf/sdf_grid.hpp"

namespace mmgrasp::detail {

enum class Seen : std::uint8_t { nothing, free, surface };

/// A voxel over all layers. The variance has a part of the pixels' and poses' errors, which differ between voxels, and
/// a systematic part, which does not.
struct Node {
  float mean = 0, variance = 0, systematic = 0;
  Seen seen = Seen::nothing;
  bool looked_through = false;  ///< Near a surface, but more frames looked through it than saw it so.
};

/// The map at a point; mean and variance mean something where known.
struct Sample {
  double mean = 0, variance = 0;
  bool known = false;
};

/// A cell, named by its lowest voxel, and where in it, from 0 to 1.
struct PlaceInCell {
  std::array<int, 3> cell;
  float t[3];

  BlockKey block() const { return {cell[0] >> 3, cell[1] >> 3, cell[2] >> 3}; }
  /// Which neighbours of its block (as bits) hold corners of the cell.
  unsigned neighbours() const {
    unsigned set = 1;
    for (int k = 0; k < 3; ++k) set |= (cell[k] & 7) == 7 ? set << (1 << k) : 0;
    return set;
  }
};

/// Not for several threads at once: it remembers the last blocks.
class SdfSampler {
 public:
  explicit SdfSampler(const SdfGrid& grid)
      : grid_(grid),
        scale_(1 / grid.options.voxel),
        voxel_(static_cast<float>(grid.options.voxel)),
        around_cell_(grid),
        around_stencil_(grid) {
    for (const DepthCamera& camera : grid.cameras) {
      systematic_ = systematic_ || camera.systematic > 0 || camera.systematic_scale > 0;
    }
  }

  /// The layers' values at a voxel, averaged with weights 1 / variance.
  Node node(int block, int voxel) const {
    Node out;
    bool looked_through = false;
    float sum = 0, mean = 0, variance = 0, systematic = 0;
    for (const auto& layer : grid_.layers) {
      const VoxelBlock* voxels = layer[block].get();
      if (!voxels) continue;
      looked_through = looked_through || voxels->looked_through;
      const float weight = voxels->weight(voxel);
      if (!(weight > 0)) continue;
      const float own = 1 / weight, shared = voxels->systematic_variance(), q = 1 / (own + shared);
      sum += q;
      mean += q * voxels->mean(voxel);
      variance += q * q * own;
      systematic += q * q * shared;
    }
    if (!(sum > 0)) return out;  // never near a surface
    out.looked_through = looked_through && more_free_than_near(block, voxel);
    if (!(mean < 0 && out.looked_through)) {
      out.mean = mean / sum;
      out.variance = variance / (sum * sum);
      out.systematic = systematic / (sum * sum);
      out.seen = Seen::surface;
    } else {
      out.mean = static_cast<float>(grid_.options.truncation);
      out.variance = out.mean * out.mean / 9;  // depths less certain than a third of the truncation are not used
      out.seen = Seen::free;
      out.looked_through = false;
    }
    return out;
  }

  /// Voxel with these indices.
  Node node_at(int x, int y, int z) {
    const int block = find({x >> 3, y >> 3, z >> 3});
    if (block < 0) return {};
    return node(block, voxel_of(x, y, z));
  }

  /// The block of the voxel below a point along each axis; negative: there is none.
  int block_at(const Eigen::Vector3d& point) {
    PlaceInCell place;
    return find_cell(point, place) ? find(place.block()) : -1;
  }

  /// Means at the corners of a cell that are all known, its lowest corner the voxel with these indices; corner k lies
  /// beyond it along x, y, z by the bits of k.
  void corners(int x, int y, int z, float* mean) {
    kept_cell_ = {x, y, z};
    around_cell_.enter({x >> 3, y >> 3, z >> 3});
    kept_corners_ = near_surface(kept_cell_, around_cell_, kept_mean_, kept_weight_);
    if (kept_corners_ == Corners::near) {
      for (int k = 0; k < 8; ++k) mean[k] = kept_mean_[k];
      return;
    }
    Node corner[8];
    bool near = false;
    for (int k = 0; k < 8; ++k) {
      corner[k] = corner_node(kept_cell_, around_cell_, k);
      near = near || corner[k].seen == Seen::surface;
    }
    if (near) bound_free_corners(corner);
    for (int k = 0; k < 8; ++k) mean[k] = corner[k].mean;
  }

  Sample at(const Eigen::Vector3d& point) {
    PlaceInCell place;
    if (!find_cell(point, place)) return {};
    around_cell_.enter(place.block());
    if (kept_corners_ == Corners::near && place.cell == kept_cell_) {
      return between(place, around_cell_, kept_mean_, kept_weight_);
    }
    return at(place, around_cell_);
  }

  /// Whether a point is near enough to the origin to lie in a cell, and where.
  bool find_cell(const Eigen::Vector3d& point, PlaceInCell& out) const {
    const Eigen::Vector3d g = point * scale_;
    if (!(g.cwiseAbs().maxCoeff() < 8.0 * kMostBlocks)) return false;
    split(g, out.cell.data(), out.t);
    return true;
  }

  /// The map at a place whose cell's block was entered.
  Sample at(const PlaceInCell& place, BlockNeighbours& around) const {
    CellValues mean, weight;
    switch (near_surface(place.cell, around, mean, weight)) {
      case Corners::unknown:
        return {};
      case Corners::near:
        return between(place, around, mean, weight);
      case Corners::mixed:
        break;
    }
    Node corner[8];
    bool near = false;
    for (int k = 0; k < 8; ++k) {
      corner[k] = corner_node(place.cell, around, k);
      if (corner[k].seen == Seen::nothing) return {};
      near = near || corner[k].seen == Seen::surface;
    }
    if (near) bound_free_corners(corner);
    return interpolate(corner, place.t, correlation_of(around));
  }

  /// Fetches the voxels that at() reads at a place whose neighbours `set` were found.
  void fetch_voxels(const PlaceInCell& place, unsigned set, BlockNeighbours& around) const {
    const int y = place.cell[1], z = place.cell[2];
    if (around.index(0) >= 0) fetch(&grid_.correlation[around.index(0)]);
    BlockNeighbours::for_each(set, [&](int which) {
      if (around.index(which) < 0) return;
      for (const auto& layer : grid_.layers) {
        const VoxelBlock* const voxels = layer[around.index(which)].get();
        if (!voxels) continue;
        fetch(&voxels->looked_through);
        for (const int w : {z, z + 1}) {
          for (const int v : {y, y + 1}) fetch(voxels->rows[voxel_of(0, v, w) >> 3]);
          fetch(voxels->near + voxel_of(0, y, w));
          fetch(voxels->free + voxel_of(0, y, w));
        }
      }
    });
  }

  /// Gradient of the mean by central differences over a voxel each way, a unit vector; zero where that leaves the
  /// known.
  Eigen::Vector3d direction(const Eigen::Vector3d& point) {
    Eigen::Vector3d near;
    if (differences_near_surface(point, near)) {
      const double span = near.norm();
      return span > 0 ? Eigen::Vector3d(near / span) : Eigen::Vector3d::Zero();
    }
    Eigen::Vector3d out;
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d step = grid_.options.voxel * Eigen::Vector3d::Unit(k);
      Sample low = at(point - step), high = at(point + step);
      const Sample here = low.known && high.known ? Sample{} : at(point);
      // One-sided where only one side is known.
      double span = 2;
      if (!low.known) {
        low = here;
        span = 1;
      }
      if (!high.known) {
        high = here;
        span = 1;
      }
      if (!low.known || !high.known || (span == 1 && !here.known)) return Eigen::Vector3d::Zero();
      out[k] = (high.mean - low.mean) / span;
    }
    const double length = out.norm();
    return length > 0 ? Eigen::Vector3d(out / length) : Eigen::Vector3d::Zero();
  }

 private:
  /// The cell of a place in voxels, and where in it that is.
  static void split(const Eigen::Vector3d& place, int* cell, float* t) {
    for (int k = 0; k < 3; ++k) {
      cell[k] = floor_of(place[k]);
      t[k] = static_cast<float>(place[k] - cell[k]);
    }
  }

  int find(const BlockKey& key) {
    if (last_valid_ && key == last_key_) return last_;
    last_valid_ = true;
    last_key_ = key;
    last_ = grid_.find(key);
    return last_;
  }

  bool more_free_than_near(int block, int voxel) const {
    int near = 0, free = 0;
    for (const auto& layer : grid_.layers) {
      const VoxelBlock* voxels = layer[block].get();
      if (!voxels) continue;
      near += voxels->near[voxel];
      free = std::max<int>(free, voxels->free[voxel]);
    }
    return free > near;
  }

  /// Interpolated variance of errors whose neighbours along an axis correlate: t (1 - t) of it averages away twice.
  static float kept(const float* t, const std::array<float, 3>& correlation) {
    float out = 1;
    for (int k = 0; k < 3; ++k) out *= 1 - 2 * t[k] * (1 - t[k]) * (1 - correlation[k]);
    return out;
  }

  static int voxel_of(int x, int y, int z) { return ((z & 7) << 6) + ((y & 7) << 3) + (x & 7); }
  /// Which block of the neighbours holds corner k of the cell.
  static int block_of(int x, int y, int z, int k) {
    return ((x & 7) + (k & 1)) >> 3 | (((y & 7) + (k >> 1 & 1)) >> 3) << 1 | (((z & 7) + (k >> 2)) >> 3) << 2;
  }

  /// Corner k of the cell; the block of its lowest corner was entered.
  Node corner_node(const std::array<int, 3>& cell, BlockNeighbours& around, int k) const {
    const int x = cell[0], y = cell[1], z = cell[2], block = around.index(block_of(x, y, z, k));
    if (block < 0) return {};
    return node(block, voxel_of(x + (k & 1), y + (k >> 1 & 1), z + (k >> 2)));
  }

  std::array<float, 3> correlation_of(BlockNeighbours& around) const {
    const int block = around.index(0);
    return block >= 0 ? grid_.correlation[block] : std::array<float, 3>{1, 1, 1};
  }

  /// Interpolates where all corners are near a surface of the only layer.
  Sample between(const PlaceInCell& place, BlockNeighbours& around, const CellValues& mean,
                 const CellValues& weight) const {
    const CellValues variance{1 / weight.low, 1 / weight.high};
    const float shared = systematic_ ? systematic_variance(place, around) : 0;
    return {trilinear(mean, place.t), trilinear(variance, place.t) * kept(place.t, correlation_of(around)) + shared,
            true};
  }

  enum class Corners : std::uint8_t { unknown, near, mixed };

  /// Means and weights of a cell's corners where all are near a surface of the only layer; mixed: ask for the nodes.
  /// The block of its lowest corner was entered.
  Corners near_surface(const std::array<int, 3>& cell, BlockNeighbours& around, CellValues& mean,
                       CellValues& weight) const {
    if (grid_.layers.size() != 1) return Corners::mixed;
    const int x = cell[0] & 7, y = cell[1] & 7, z = cell[2] & 7;
    const bool inside = x < 7 && y < 7 && z < 7;
    const VoxelBlock* const first = around.voxels(0);
    if (!first) return Corners::unknown;
    bool looked_through = first->looked_through;
    // Pairs along x share a row, or cross into the next block.
    const float *low[4], *high[4];
    for (int pair = 0; pair < 4; ++pair) {
      const int v = y + (pair & 1), w = z + (pair >> 1);
      const VoxelBlock *here = first, *beside = first;
      if (!inside) {
        const int beyond = (v >> 3) << 1 | (w >> 3) << 2;
        here = around.voxels(beyond);
        beside = x < 7 ? here : around.voxels(beyond | 1);
        if (!here || !beside) return Corners::unknown;
        looked_through = looked_through || here->looked_through || beside->looked_through;
      }
      const int row = (w & 7) << 3 | (v & 7);
      low[pair] = here->rows[row] + x;
      high[pair] = beside->rows[row] + ((x + 1) & 7);
    }
    const auto values = [&](int at) {
      return CellValues{Four{low[0][at], high[0][at], low[1][at], high[1][at]},
                        Four{low[2][at], high[2][at], low[3][at], high[3][at]}};
    };
    mean = values(0);
    weight = values(kBlockSide);
    if (!all_positive(least_of(weight.low, weight.high))) return Corners::unknown;
    for (int k = 0; looked_through && k < 8; ++k) {
      if (!(mean[k] < 0)) continue;
      const VoxelBlock& voxels = inside ? *first : *around.voxels(block_of(x, y, z, k));
      if (voxels.carved(voxel_of(x + (k & 1), y + (k >> 1 & 1), z + (k >> 2)))) return Corners::mixed;
    }
    return Corners::near;
  }

  /// The systematic variance of the only layer, between the blocks of a cell's corners.
  float systematic_variance(const PlaceInCell& place, BlockNeighbours& around) const {
    CellValues shared;
    for (int k = 0; k < 8; ++k) {
      const VoxelBlock* const block = around.voxels(block_of(place.cell[0], place.cell[1], place.cell[2], k));
      shared.set(k, block->systematic_variance());
    }
    return trilinear(shared, place.t);
  }

  /// The common case of direction(): one layer, all voxels around near a surface. Each is read once.
  bool differences_near_surface(const Eigen::Vector3d& point, Eigen::Vector3d& out) {
    const Eigen::Vector3d g = point * scale_;
    if (grid_.layers.size() != 1 || !(g.cwiseAbs().maxCoeff() < 8.0 * kMostBlocks - 2)) return false;
    int cell[3];
    float t[3];
    split(g, cell, t);
    const int first[3] = {cell[0] - 1, cell[1] - 1, cell[2] - 1};
    around_stencil_.enter({first[0] >> 3, first[1] >> 3, first[2] >> 3});
    // Central differences of interpolated values are interpolated differences. The voxels from one before the cell to
    // one behind it, without edges and corners, are added up with the weights of the two other axes.
    float along[3][4] = {}, least = 1;
    const float share[3][4] = {{0, 1 - t[0], t[0], 0}, {0, 1 - t[1], t[1], 0}, {0, 1 - t[2], t[2], 0}};
    bool looked_through = false;
    const int u = first[0] & 7, crosses = u > 4;
    for (int z = 0; z < 4; ++z) {
      for (int y = 0; y < 4; ++y) {
        const int outside = (z == 0 || z == 3) + (y == 0 || y == 3);
        if (outside == 2) continue;
        const int v = (first[1] & 7) + y, w = (first[2] & 7) + z, beyond = (v >> 3) << 1 | (w >> 3) << 2;
        const int row = (w & 7) << 3 | (v & 7);
        const VoxelBlock* const low = around_stencil_.voxels(beyond);
        const VoxelBlock* const high = crosses ? around_stencil_.voxels(beyond | 1) : low;
        if (!low || !high) return false;
        looked_through = looked_through || low->looked_through || high->looked_through;
        for (int x = outside; x < 4 - outside; ++x) {
          const float* const at = (u + x < 8 ? low : high)->rows[row] + ((u + x) & 7);
          const float mean = at[0];
          least = std::min(least, at[kBlockSide]);
          along[0][x] += share[1][y] * share[2][z] * mean;
          along[1][y] += share[0][x] * share[2][z] * mean;
          along[2][z] += share[0][x] * share[1][y] * mean;
        }
      }
    }
    if (!(least > 0) || (looked_through && stencil_carved(first))) return false;
    for (int k = 0; k < 3; ++k) {
      out[k] = 0.5 * ((1 - t[k]) * (along[k][2] - along[k][0]) + t[k] * (along[k][3] - along[k][1]));
    }
    return true;
  }

  /// Whether one of the voxels that differences_near_surface() reads was only looked through.
  bool stencil_carved(const int* first) {
    for (int z = 0; z < 4; ++z) {
      for (int y = 0; y < 4; ++y) {
        const int outside = (z == 0 || z == 3) + (y == 0 || y == 3);
        for (int x = outside; x < 4 - outside; ++x) {
          const int u = (first[0] & 7) + x, v = (first[1] & 7) + y, w = (first[2] & 7) + z;
          const VoxelBlock& voxels = *around_stencil_.voxels(u >> 3 | (v >> 3) << 1 | (w >> 3) << 2);
          if (voxels.looked_through && voxels.carved(voxel_of(u, v, w))) return true;
        }
      }
    }
    return false;
  }

  /// Gives corners that were only looked through a lower bound: the distance grows no faster than the way from
  /// the nearest corner whose distance is known.
  void bound_free_corners(Node* corner) const {
    static const float kWay[4] = {0, 1, std::sqrt(2.0f), std::sqrt(3.0f)};
    const Node before[8] = {corner[0], corner[1], corner[2], corner[3], corner[4], corner[5], corner[6], corner[7]};
    for (int k = 0; k < 8; ++k) {
      if (before[k].seen != Seen::free) continue;
      for (int j = 0; j < 8; ++j) {
        if (before[j].seen != Seen::surface) continue;
        const int differ = k ^ j;
        const float bound = before[j].mean + voxel_ * kWay[(differ & 1) + (differ >> 1 & 1) + (differ >> 2)];
        if (bound >= corner[k].mean) continue;
        corner[k] = before[j];
        corner[k].mean = bound;
      }
    }
  }

  static Sample interpolate(const Node* corner, const float* t, const std::array<float, 3>& correlation) {
    CellValues mean, variance, systematic;
    for (int k = 0; k < 8; ++k) {
      mean.set(k, corner[k].mean);
      variance.set(k, corner[k].variance);
      systematic.set(k, corner[k].systematic);
    }
    return {trilinear(mean, t), trilinear(variance, t) * kept(t, correlation) + trilinear(systematic, t), true};
  }

  const SdfGrid& grid_;
  const double scale_;
  const float voxel_;
  bool systematic_ = false;  ///< Some camera has a systematic error.
  BlockNeighbours around_cell_, around_stencil_;
  // The cell that corners() was asked for last: where a ray ends in it, at() is next.
  std::array<int, 3> kept_cell_{};
  Corners kept_corners_ = Corners::unknown;
  CellValues kept_mean_, kept_weight_;
  BlockKey last_key_;
  int last_ = -1;
  bool last_valid_ = false;
};

}  // namespace mmgrasp::detail
