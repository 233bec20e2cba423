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

class Marcher {
 public:
  Marcher(const SdfGrid& grid, SdfSampler& sampler, const Vector3d& origin, const Vector3d& direction)
      : sampler_(sampler), origin_(origin), direction_(direction), metre_(1 / direction.norm()) {
    least_ = 0.5 * grid.options.voxel * metre_;
    enough_ = 1e-4 * grid.options.voxel;
  }

  /// Marches through a stretch where blocks are; true when the surface was crossed.
  bool march(double begin, double end) {
    double t = std::max(begin, next_);
    while (t < end) {
      const Sample here = sampler_.at(origin_ + t * direction_);
      if (here.known && here.mean <= 0 && in_front_) {
        crossing_ = refine(last_t_, last_mean_, t, here.mean);
        return true;
      }
      in_front_ = here.known && here.mean > 0;
      last_t_ = t;
      last_mean_ = here.mean;
      // The distance bounds the way to the surface, but for noise and slant: go less far. Where nothing is known yet,
      // less than the 1.75 voxels that are known in front of every surface.
      t += in_front_ ? std::max(least_, 0.7 * here.mean * metre_) : 2.8 * least_;
    }
    next_ = t;
    return false;
  }
  /// Between blocks nothing is known.
  void leave() { in_front_ = false; }
  double crossing() const { return crossing_; }

 private:
  double refine(double a, double fa, double b, double fb) {
    for (int k = 0; k < 4; ++k) {
      const double t = a + (b - a) * std::clamp(fa / (fa - fb), 0.05, 0.95);
      const Sample here = sampler_.at(origin_ + t * direction_);
      if (!here.known) break;
      if (std::abs(here.mean) < enough_) return t;
      (here.mean > 0 ? a : b) = t;
      (here.mean > 0 ? fa : fb) = here.mean;
    }
    return a + (b - a) * fa / (fa - fb);
  }

  SdfSampler& sampler_;
  const Vector3d &origin_, &direction_;
  double metre_, least_ = 0, enough_ = 0;
  double next_ = -kInfinity, last_t_ = 0, last_mean_ = 0, crossing_ = kNone;
  bool in_front_ = false;
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

double first_crossing(const SdfGrid& grid, const Eigen::AlignedBox3d& bounds, SdfSampler& sampler,
                      const Vector3d& origin, const Vector3d& direction) {
  double begin = 0, end = kInfinity;
  if (bounds.isEmpty() || !clip(bounds, origin, direction, begin, end)) return kNone;
  const double block = kBlockSide * grid.options.voxel;
  Marcher marcher(grid, sampler, origin, direction);
  const BlockKey lowest{-kMostBlocks, -kMostBlocks, -kMostBlocks}, highest{kMostBlocks, kMostBlocks, kMostBlocks};
  for (CellWalk wide(origin, direction, kBlockSide * block, begin, end, lowest, highest); !wide.done();
       wide.advance()) {
    const BlockKey outer = wide.cell(), first{8 * outer.x, 8 * outer.y, 8 * outer.z},
                   last{first.x + 7, first.y + 7, first.z + 7};
    const int at = grid.mask_table.find(outer.packed());
    if (at < 0) {
      marcher.leave();
      continue;
    }
    const BlockMask& mask = grid.masks[at];
    for (CellWalk walk(origin, direction, block, wide.begin(), wide.end(), first, last); !walk.done(); walk.advance()) {
      const BlockKey cell = walk.cell();
      const bool there = mask[cell.z & 7] >> (8 * (cell.y & 7) + (cell.x & 7)) & 1;
      if (!there) {
        marcher.leave();
      } else if (marcher.march(walk.begin(), walk.end())) {
        return marcher.crossing();
      }
    }
  }
  return kNone;
}

}  // namespace mmgrasp::detail
