#pragma once

// Reads a grid at voxels and between them.

#include <algorithm>
#include <cmath>

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

/// Not for several threads at once: it remembers the last block.
class SdfSampler {
 public:
  explicit SdfSampler(const SdfGrid& grid)
      : grid_(grid), scale_(1 / grid.options.voxel), voxel_(static_cast<float>(grid.options.voxel)) {}

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
      out.seen = Seen::free;
      out.looked_through = false;
    }
    return out;
  }

  /// Voxel with these indices.
  Node node_at(int x, int y, int z) {
    const int block = find({x >> 3, y >> 3, z >> 3});
    if (block < 0) return {};
    return node(block, ((z & 7) << 6) + ((y & 7) << 3) + (x & 7));
  }

  /// Fetches what at() will read of this point.
  void prefetch(const Eigen::Vector3d& point) {
    const Eigen::Vector3d g = point * scale_;
    if (!(g.cwiseAbs().maxCoeff() < 8.0 * kMostBlocks)) return;
    const int x = static_cast<int>(std::floor(g.x())), y = static_cast<int>(std::floor(g.y())),
              z = static_cast<int>(std::floor(g.z()));
    const int block = find({x >> 3, y >> 3, z >> 3});
    if (block < 0) return;
    for (const auto& layer : grid_.layers) {
      if (!layer[block]) continue;
      const int row = ((z & 7) << 3) + (y & 7);
      for (const int each : {row, row + 1, row + 8, row + 9}) __builtin_prefetch(layer[block]->rows[each & 63]);
    }
  }

  /// Means at the corners of a cell that are all known, its lowest corner the voxel with these indices; corner k lies
  /// beyond it along x, y, z by the bits of k.
  void corners(int x, int y, int z, float* mean) {
    const int block = find({x >> 3, y >> 3, z >> 3});
    const int u = x & 7, v = y & 7, w = z & 7;
    if (grid_.layers.size() == 1 && u < 7 && v < 7 && w < 7) {
      const VoxelBlock& voxels = *grid_.layers[0][block];
      bool all = true;
      for (int k = 0; k < 8; ++k) {
        const int i = ((w + (k >> 2)) << 6) + ((v + (k >> 1 & 1)) << 3) + u + (k & 1);
        all = all && voxels.weight(i) > 0 && !voxels.carved(i);
        mean[k] = voxels.mean(i);
      }
      if (all) return;
    }
    Node corner[8];
    bool near = false;
    for (int k = 0; k < 8; ++k) {
      corner[k] = node_at(x + (k & 1), y + (k >> 1 & 1), z + (k >> 2));
      near = near || corner[k].seen == Seen::surface;
    }
    if (near) bound_free_corners(corner);
    for (int k = 0; k < 8; ++k) mean[k] = corner[k].mean;
  }

  Sample at(const Eigen::Vector3d& point) {
    const Eigen::Vector3d g = point * scale_;
    constexpr double kFarthest = 8.0 * kMostBlocks;
    if (!(g.cwiseAbs().maxCoeff() < kFarthest)) return {};
    int cell[3];
    float t[3];
    split(g, cell, t);
    const int block = find({cell[0] >> 3, cell[1] >> 3, cell[2] >> 3});
    const int x = cell[0] & 7, y = cell[1] & 7, z = cell[2] & 7;
    if (block >= 0 && grid_.layers.size() == 1 && x < 7 && y < 7 && z < 7) {
      Sample out;
      if (inside_block(*grid_.layers[0][block], (z << 6) + (y << 3) + x, t, grid_.correlation[block], out)) return out;
    }
    Node corner[8];
    int first_known = -1;
    for (int k = 0; k < 8; ++k) {
      const int dx = k & 1, dy = k >> 1 & 1, dz = k >> 2;
      const bool same = block >= 0 && x + dx < 8 && y + dy < 8 && z + dz < 8;
      corner[k] = same ? node(block, ((z + dz) << 6) + ((y + dy) << 3) + x + dx)
                       : node_at(cell[0] + dx, cell[1] + dy, cell[2] + dz);
      if (corner[k].seen == Seen::nothing) return {};
      if (first_known < 0 && corner[k].seen == Seen::surface) first_known = k;
    }
    if (first_known >= 0) bound_free_corners(corner);
    return interpolate(corner, t, block >= 0 ? grid_.correlation[block] : std::array<float, 3>{1, 1, 1});
  }

  /// Interpolates the values at a cell's corners to a place in it, from (0, 0, 0) to (1, 1, 1).
  static float trilinear(const float* v, const float* t) {
    const float a = v[0] + t[0] * (v[1] - v[0]), b = v[2] + t[0] * (v[3] - v[2]), c = v[4] + t[0] * (v[5] - v[4]),
                d = v[6] + t[0] * (v[7] - v[6]);
    const float e = a + t[1] * (b - a), f = c + t[1] * (d - c);
    return e + t[2] * (f - e);
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
      const double floor = std::floor(place[k]);
      cell[k] = static_cast<int>(floor);
      t[k] = static_cast<float>(place[k] - floor);
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

  /// The common case of direction(): one layer, all voxels around near a surface. Each is read once.
  bool differences_near_surface(const Eigen::Vector3d& point, Eigen::Vector3d& out) {
    const Eigen::Vector3d g = point * scale_;
    if (grid_.layers.size() != 1 || !(g.cwiseAbs().maxCoeff() < 8.0 * kMostBlocks - 2)) return false;
    int cell[3];
    float t[3];
    split(g, cell, t);
    float mean[4][4][4];  // [z][y][x] from one voxel before the cell to one behind it, without edges and corners
    for (int z = -1; z <= 2; ++z) {
      for (int y = -1; y <= 2; ++y) {
        const int outside = (z < 0 || z > 1) + (y < 0 || y > 1);
        for (int x = outside == 0 ? -1 : 0; outside < 2 && x <= (outside == 0 ? 2 : 1); ++x) {
          const int place[3] = {cell[0] + x, cell[1] + y, cell[2] + z};
          const int block = find({place[0] >> 3, place[1] >> 3, place[2] >> 3});
          const VoxelBlock* voxels = block < 0 ? nullptr : grid_.layers[0][block].get();
          const int voxel = ((place[2] & 7) << 6) + ((place[1] & 7) << 3) + (place[0] & 7);
          if (!voxels || !(voxels->weight(voxel) > 0) || voxels->carved(voxel)) return false;
          mean[z + 1][y + 1][x + 1] = voxels->mean(voxel);
        }
      }
    }
    for (int k = 0; k < 3; ++k) {
      float end[2];
      for (int way = 0; way < 2; ++way) {
        float corner[8];
        const int shift[3] = {k == 0 ? 2 * way : 1, k == 1 ? 2 * way : 1, k == 2 ? 2 * way : 1};
        for (int c = 0; c < 8; ++c) corner[c] = mean[shift[2] + (c >> 2)][shift[1] + (c >> 1 & 1)][shift[0] + (c & 1)];
        end[way] = trilinear(corner, t);
      }
      out[k] = 0.5 * (static_cast<double>(end[1]) - end[0]);
    }
    return true;
  }

  /// The common case: eight voxels of one block, one layer, all near a surface.
  bool inside_block(const VoxelBlock& voxels, int first, const float* t, const std::array<float, 3>& correlation,
                    Sample& out) const {
    static constexpr int kOffsets[8] = {0, 1, 8, 9, 64, 65, 72, 73};
    float mean[8], variance[8];
    for (int k = 0; k < 8; ++k) {
      const int i = first + kOffsets[k];
      if (!(voxels.weight(i) > 0) || voxels.carved(i)) return false;
      mean[k] = voxels.mean(i);
      variance[k] = 1 / voxels.weight(i);
    }
    out.mean = trilinear(mean, t);
    out.variance = trilinear(variance, t) * kept(t, correlation) + voxels.systematic_variance();
    out.known = true;
    return true;
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
    float mean[8], variance[8], systematic[8];
    for (int k = 0; k < 8; ++k) {
      mean[k] = corner[k].mean;
      variance[k] = corner[k].variance;
      systematic[k] = corner[k].systematic;
    }
    return {trilinear(mean, t), trilinear(variance, t) * kept(t, correlation) + trilinear(systematic, t), true};
  }

  const SdfGrid& grid_;
  const double scale_;
  const float voxel_;
  BlockKey last_key_;
  int last_ = -1;
  bool last_valid_ = false;
};

}  // namespace mmgrasp::detail
