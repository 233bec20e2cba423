#include "mapping/sdf/ray_march.hpp"

#include <limits>

#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::Vector3d;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Walks the cells of a lattice along a ray, from t = begin to t = end, through the cells from `first` to `last` on
/// each axis: a start on a wall belongs to the cell on their side of it, and so does what rounding leaves at the end.
class CellWalk {
 public:
  CellWalk(const Vector3d& origin, const Vector3d& direction, double side, double begin, double end,
           const BlockKey& first, const BlockKey& last)
      : t_(begin), end_(end) {
    const Vector3d start = origin + begin * direction;
    const int low[3] = {first.x, first.y, first.z}, high[3] = {last.x, last.y, last.z};
    for (int k = 0; k < 3; ++k) {
      const double place = std::clamp<double>(std::floor(start[k] / side), low[k], high[k]);
      cell_[k] = static_cast<int>(place);
      step_[k] = direction[k] > 0 ? 1 : -1;
      past_[k] = direction[k] > 0 ? high[k] + 1 : low[k] - 1;
      delta_[k] = direction[k] != 0 ? side / std::abs(direction[k]) : kInfinity;
      const double wall = (place + (direction[k] > 0 ? 1 : 0)) * side;
      next_[k] = direction[k] != 0 ? std::max(begin, (wall - origin[k]) / direction[k]) : kInfinity;
    }
  }
  bool done() const { return t_ >= end_ || left_; }
  BlockKey cell() const { return {cell_[0], cell_[1], cell_[2]}; }
  double begin() const { return t_; }
  double end() const { return std::min({next_[0], next_[1], next_[2], end_}); }
  void advance() {
    const int k = next_[0] < next_[1] ? (next_[0] < next_[2] ? 0 : 2) : (next_[1] < next_[2] ? 1 : 2);
    t_ = next_[k];
    next_[k] += delta_[k];
    cell_[k] += step_[k];
    left_ = cell_[k] == past_[k];
  }

 private:
  double t_, end_, next_[3], delta_[3];
  int cell_[3], step_[3], past_[3];
  bool left_ = false;
};

/// The map between the eight corners of one cell, along a ray.
class CellAlongRay {
 public:
  CellAlongRay(const SdfGrid& grid, SdfSampler& sampler, const BlockKey& cell, const Vector3d& origin,
               const Vector3d& direction)
      : first_(origin / grid.options.voxel - Vector3d(cell.x, cell.y, cell.z)), slope_(direction / grid.options.voxel) {
    sampler.corners(cell.x, cell.y, cell.z, mean_);
  }
  double mean(double t) const {
    float place[3];
    for (int k = 0; k < 3; ++k) place[k] = static_cast<float>(std::clamp(first_[k] + t * slope_[k], 0.0, 1.0));
    return SdfSampler::trilinear(mean_, place);
  }

 private:
  Vector3d first_, slope_;
  float mean_[8];
};

/// Follows one ray through the cells and finds where the mean distance crosses zero from the front.
class Marcher {
 public:
  Marcher(const SdfGrid& grid, SdfSampler& sampler, const Vector3d& origin, const Vector3d& direction)
      : grid_(grid), sampler_(sampler), origin_(origin), direction_(direction) {
    half_voxel_ = 0.5 * grid.options.voxel / direction.norm();
    enough_ = 1e-4 * grid.options.voxel;
  }

  /// First crossing from the front within a cell that the ray is in from t = begin to t = end; NaN: none. Between
  /// looks half a voxel apart it is crossed once at most.
  double crossing(const BlockKey& cell, double begin, double end) const {
    const CellAlongRay along(grid_, sampler_, cell, origin_, direction_);
    double last = begin, last_mean = along.mean(begin);
    if (last_mean <= 0 && from_the_front(begin)) return begin;
    const int steps = std::max(1, static_cast<int>(std::ceil((end - begin) / half_voxel_)));
    for (int i = 1; i <= steps; ++i) {
      const double t = begin + (end - begin) * i / steps, mean = along.mean(t);
      if (last_mean > 0 && mean <= 0) return refine(along, last, last_mean, t, mean);
      last = t;
      last_mean = mean;
    }
    return kNone;
  }

 private:
  /// Where voxels were only looked through, cells do not fit together: one can be in front, the next behind. And a
  /// crossing on the border of two cells may, by rounding, be in neither.
  bool from_the_front(double t) const {
    constexpr double kBefore = 0.1;  // half voxels: far enough to tell the side from roundings
    if (t - kBefore * half_voxel_ <= 0) return false;
    const Sample before = sampler_.at(origin_ + (t - kBefore * half_voxel_) * direction_);
    return before.known && before.mean > 0;
  }

  double refine(const CellAlongRay& along, double a, double fa, double b, double fb) const {
    for (int k = 0; k < 8; ++k) {
      const double t = a + (b - a) * std::clamp(fa / (fa - fb), 0.05, 0.95), mean = along.mean(t);
      if (std::abs(mean) < enough_) return t;
      (mean > 0 ? a : b) = t;
      (mean > 0 ? fa : fb) = mean;
    }
    return a + (b - a) * fa / (fa - fb);
  }

  const SdfGrid& grid_;
  SdfSampler& sampler_;
  const Vector3d &origin_, &direction_;
  double half_voxel_ = 0, enough_ = 0;
};

bool clip(const Eigen::AlignedBox3d& box, const Vector3d& origin, const Vector3d& direction, double& begin,
          double& end) {
  for (int k = 0; k < 3; ++k) {
    if (direction[k] == 0) {
      if (origin[k] < box.min()[k] || origin[k] > box.max()[k]) return false;
      continue;
    }
    const double a = (box.min()[k] - origin[k]) / direction[k], b = (box.max()[k] - origin[k]) / direction[k];
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  return begin < end;
}

}  // namespace

double first_crossing(const SdfGrid& grid, CrossingCells& crossing, SdfSampler& sampler, const Vector3d& origin,
                      const Vector3d& direction) {
  double begin = 0, end = kInfinity;
  if (grid.bounds.isEmpty() || !clip(grid.bounds, origin, direction, begin, end)) return kNone;
  const double voxel = grid.options.voxel, block = kBlockSide * voxel;
  const Marcher marcher(grid, sampler, origin, direction);
  const BlockKey lowest{-kMostBlocks, -kMostBlocks, -kMostBlocks}, highest{kMostBlocks, kMostBlocks, kMostBlocks};
  for (CellWalk wide(origin, direction, kBlockSide * block, begin, end, lowest, highest); !wide.done();
       wide.advance()) {
    const BlockKey outer = wide.cell(), first{8 * outer.x, 8 * outer.y, 8 * outer.z},
                   last{first.x + 7, first.y + 7, first.z + 7};
    const int at = grid.mask_table.find(outer.packed());
    if (at < 0) continue;
    const BlockMask& mask = grid.masks[at];
    for (CellWalk walk(origin, direction, block, wide.begin(), wide.end(), first, last); !walk.done(); walk.advance()) {
      const BlockKey key = walk.cell(), low{8 * key.x, 8 * key.y, 8 * key.z}, high{low.x + 7, low.y + 7, low.z + 7};
      if (!(mask[key.z & 7] >> (8 * (key.y & 7) + (key.x & 7)) & 1)) continue;
      const std::atomic<std::uint64_t>* words = crossing.of(grid.find(key), key, sampler);
      if (!words) continue;
      for (CellWalk cells(origin, direction, voxel, walk.begin(), walk.end(), low, high); !cells.done();
           cells.advance()) {
        const BlockKey cell = cells.cell();
        const std::uint64_t word = words[cell.z & 7].load(std::memory_order_relaxed);
        if (!(word >> (8 * (cell.y & 7) + (cell.x & 7)) & 1)) continue;
        const double t = marcher.crossing(cell, cells.begin(), cells.end());
        if (!std::isnan(t)) return t;
      }
    }
  }
  return kNone;
}

}  // namespace mmgrasp::detail
