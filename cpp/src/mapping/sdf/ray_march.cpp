#include "mapping/sdf/ray_march.hpp"

#include <limits>

#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::Vector3d;
constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// A ray with a unit direction, and 1 / direction; where that is not finite it leaves no cell along the axis.
struct Way {
  const Vector3d &origin, &direction, &inverse;
};

/// Walks cells along a ray from t = begin to t = end, `count` (a power of two) a side from `first` on. A start on a
/// wall belongs to the cell on the side of it that rounding says, and so does what rounding leaves at the end.
class CellWalk {
 public:
  CellWalk(const Way& way, double side, double begin, double end, const BlockKey& first, int count)
      : t_(begin), end_(end), outside_(~(static_cast<std::uint64_t>(count - 1) * kUnits)) {
    const double per_side = 1 / side;
    const int low[3] = {first.x, first.y, first.z};
    for (int k = 0; k < 3; ++k) {
      const bool up = way.direction[k] > 0, moves = std::abs(way.inverse[k]) < kInfinity;
      const int at = floor_of((way.origin[k] + begin * way.direction[k]) * per_side);
      const int cell = std::clamp(at, low[k], low[k] + count - 1);
      place_ += static_cast<std::uint64_t>(cell - low[k]) << kShift[k];
      step_[k] = (up ? 1 : ~std::uint64_t{0}) << kShift[k];
      delta_[k] = side * std::abs(way.inverse[k]);
      next_[k] = moves ? std::max(begin, ((cell + up) * side - way.origin[k]) * way.inverse[k]) : kInfinity;
    }
  }
  bool done() const { return t_ >= end_ || (place_ & outside_) != 0; }
  /// The cell from `first` on, packed as BlockKey is, without its offset.
  std::uint64_t place() const { return place_; }
  double begin() const { return t_; }
  double end() const { return std::min(std::min(next_[0], next_[1]), std::min(next_[2], end_)); }
  void advance() {
    if (next_[0] < next_[1]) {
      next_[0] < next_[2] ? step(0) : step(2);
    } else {
      next_[1] < next_[2] ? step(1) : step(2);
    }
  }

 private:
  static constexpr int kShift[3] = {42, 21, 0};
  static constexpr std::uint64_t kUnits = std::uint64_t{1} << 42 | std::uint64_t{1} << 21 | 1;
  void step(int k) {
    t_ = next_[k];
    next_[k] += delta_[k];
    place_ += step_[k];
  }

  double t_, end_, next_[3], delta_[3];
  std::uint64_t place_ = 0, step_[3];
  const std::uint64_t outside_;  // bits that are set beyond the last cell, or before the first
};

constexpr int kWide = 1 << 20;
const BlockKey kLowest{-kWide, -kWide, -kWide};  // so that a place is a packed key

/// Where in an 8 x 8 x 8 lattice.
int z_of(std::uint64_t place) {
  return static_cast<int>(place & 7);
}
int xy_of(std::uint64_t place) {
  return static_cast<int>(place >> 21 & 7) << 3 | static_cast<int>(place >> 42 & 7);
}
BlockKey cell_of(const BlockKey& first, std::uint64_t place) {
  return {first.x + static_cast<int>(place >> 42), first.y + static_cast<int>(place >> 21 & 7),
          first.z + static_cast<int>(place & 7)};
}

/// The map between the eight corners of one cell along a ray: a cubic polynomial of s, from 0 where the ray is at
/// `place`, voxels from the lowest corner, in steps of `slope`.
class CellAlongRay {
 public:
  CellAlongRay(const float* mean, const Vector3d& place, const Vector3d& slope) {
    const double x = place.x(), y = place.y(), z = place.z(), dx = slope.x(), dy = slope.y(), dz = slope.z();
    double of_y[2][3];  // between two of the four edges along x
    for (int k = 0; k < 2; ++k) {
      const float* const m = mean + 4 * k;
      const double low = m[1] - m[0], high = m[3] - m[2], start = m[0] + low * x, slant = low * dx;
      const double apart = m[2] + high * x - start, growing = high * dx - slant;
      of_y[k][0] = start + apart * y;
      of_y[k][1] = slant + growing * y + apart * dy;
      of_y[k][2] = growing * dy;
    }
    for (int k = 0; k < 3; ++k) of_y[1][k] -= of_y[0][k];
    power_[0] = of_y[0][0] + of_y[1][0] * z;
    power_[1] = of_y[0][1] + of_y[1][1] * z + of_y[1][0] * dz;
    power_[2] = of_y[0][2] + of_y[1][2] * z + of_y[1][1] * dz;
    power_[3] = of_y[1][2] * dz;
  }
  double mean(double s) const { return power_[0] + s * (power_[1] + s * (power_[2] + s * power_[3])); }

 private:
  double power_[4];
};

/// Where the mean is zero between a, where it is fa > 0, and b, where it is fb <= 0.
double refine(const CellAlongRay& along, double a, double fa, double b, double fb, double enough) {
  for (int k = 0; k < 8; ++k) {
    const double s = a + (b - a) * std::clamp(fa / (fa - fb), 0.05, 0.95), mean = along.mean(s);
    if (std::abs(mean) < enough) return s;
    (mean > 0 ? a : b) = s;
    (mean > 0 ? fa : fb) = mean;
  }
  return a + (b - a) * fa / (fa - fb);
}

void clip(const Eigen::AlignedBox3d& box, const Vector3d& origin, const Vector3d& inverse, double& begin, double& end) {
  for (int k = 0; k < 3; ++k) {
    if (std::abs(inverse[k]) < kInfinity) {
      const double a = (box.min()[k] - origin[k]) * inverse[k], b = (box.max()[k] - origin[k]) * inverse[k];
      begin = std::max(begin, std::min(a, b));
      end = std::min(end, std::max(a, b));
    } else if (origin[k] < box.min()[k] || origin[k] > box.max()[k]) {
      end = begin;
    }
  }
}

bool flagged(const std::atomic<std::uint64_t>* words, std::uint64_t place) {
  return words[z_of(place)].load(std::memory_order_relaxed) >> xy_of(place) & 1;
}

BlockKey first_of(const BlockKey& outer) {
  return {kBlockSide * outer.x, kBlockSide * outer.y, kBlockSide * outer.z};
}

}  // namespace

RayMarch::RayMarch(const SdfGrid& grid, CrossingCells& crossing, SdfSampler& sampler, const Vector3d& origin,
                   const Vector3d& direction)
    : grid_(grid),
      crossing_(crossing),
      sampler_(sampler),
      origin_(origin),
      direction_(direction),
      inverse_(direction.cwiseInverse()) {
  if (grid.bounds.isEmpty()) return;
  end_ = kInfinity;
  clip(grid.bounds, origin, inverse_, begin_, end_);
}

BlockOnRay RayMarch::first_block() const {
  return next_block(begin_);
}

double RayMarch::crossing(BlockOnRay in) const {
  while (in.block >= 0) {
    const double t = crossing_in(in);
    if (!std::isnan(t)) return t;
    in = next_block(in.end);
  }
  return kNone;
}

BlockOnRay RayMarch::next_block(double begin) const {
  const Way way{origin_, direction_, inverse_};
  const double voxel = grid_.options.voxel, block = kBlockSide * voxel;
  for (CellWalk wide(way, kBlockSide * block, begin, end_, kLowest, 2 * kWide); !wide.done(); wide.advance()) {
    const int at = grid_.mask_table.find(wide.place());
    if (at < 0) continue;
    const BlockMask& mask = grid_.masks[at];
    const BlockKey first = first_of(BlockKey::unpack(wide.place()));
    for (CellWalk walk(way, block, wide.begin(), wide.end(), first, kBlockSide); !walk.done(); walk.advance()) {
      if (!(mask[z_of(walk.place())] >> xy_of(walk.place()) & 1)) continue;
      const BlockKey key = cell_of(first, walk.place());
      const int found = grid_.find(key);
      const std::atomic<std::uint64_t>* words = crossing_.of(found, key, sampler_);
      if (!words) continue;
      CellWalk cells(way, voxel, walk.begin(), walk.end(), first_of(key), kBlockSide);
      for (; !cells.done(); cells.advance()) {
        if (flagged(words, cells.place())) return {found, key, cells.begin(), walk.end()};
      }
    }
  }
  return {};
}

double RayMarch::crossing_in(const BlockOnRay& in) const {
  const Way way{origin_, direction_, inverse_};
  const std::atomic<std::uint64_t>* words = crossing_.of(in.block, in.key, sampler_);
  const BlockKey first = first_of(in.key);
  CellWalk cells(way, grid_.options.voxel, in.begin, in.end, first, kBlockSide);
  for (; !cells.done(); cells.advance()) {
    if (!flagged(words, cells.place())) continue;
    const double t = crossing_of(cell_of(first, cells.place()), cells.begin(), cells.end());
    if (!std::isnan(t)) return t;
  }
  return kNone;
}

/// First crossing from the front within a cell that the ray is in from t = begin to t = end; NaN: none. Between looks
/// half a voxel apart it is crossed once at most.
double RayMarch::crossing_of(const BlockKey& cell, double begin, double end) const {
  const double voxel = grid_.options.voxel, per_voxel = 1 / voxel;
  const Vector3d start = (origin_ + begin * direction_) * per_voxel - Vector3d(cell.x, cell.y, cell.z);
  float corner[8];
  sampler_.corners(cell.x, cell.y, cell.z, corner);
  const CellAlongRay along(corner, start.cwiseMax(0).cwiseMin(1), direction_ * per_voxel);
  double last = 0, last_mean = along.mean(0);
  if (last_mean <= 0 && from_the_front(begin)) return begin;
  const int steps = 1 + static_cast<int>((end - begin) * 2 * per_voxel);
  const double step = (end - begin) / steps;
  for (int i = 1; i <= steps; ++i) {
    const double s = i * step, mean = along.mean(s);
    if (last_mean > 0 && mean <= 0) return begin + refine(along, last, last_mean, s, mean, 1e-4 * voxel);
    last = s;
    last_mean = mean;
  }
  return kNone;
}

/// Where voxels were only looked through, cells do not fit together: one can be in front, the next behind. And a
/// crossing on the border of two cells may, by rounding, be in neither.
bool RayMarch::from_the_front(double t) const {
  const double before_t = t - 0.05 * grid_.options.voxel;  // far enough to tell the side from roundings
  if (before_t <= 0) return false;
  const Sample before = sampler_.at(origin_ + before_t * direction_);
  return before.known && before.mean > 0;
}

}  // namespace mmgrasp::detail
