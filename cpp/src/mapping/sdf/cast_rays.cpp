#include "mapping/sdf/cast_rays.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "mapping/sdf/block_order.hpp"
#include "mapping/sdf/ray_march.hpp"

namespace mmgrasp::detail {

namespace {

constexpr std::size_t kAhead = 6;  // rays that are fetched before they are needed

/// A direction as a unit vector, and its length.
struct UnitDirection {
  explicit UnitDirection(const Eigen::Vector3d& direction) : length(direction.norm()), unit(direction / length) {
    if (length > 1e-100 && length < 1e100) return;
    length = direction.stableNorm();
    unit = direction.stableNormalized();
  }
  double length;
  Eigen::Vector3d unit;
};

/// Standard deviation of the surface at a hit. A hit on the border of what is known may lie beyond it by rounding: then
/// it is that beside. Between cells that do not fit together, in front and behind, the map is not zero: how far it is
/// from that counts, on the side that lies behind.
double sigma_at(SdfSampler& sampler, const Eigen::Vector3d& hit, const Eigen::Vector3d& direction,
                const SdfOptions& options) {
  const Eigen::Vector3d step = 0.05 * options.voxel * direction;
  Sample sample = sampler.at(hit);
  if (!sample.known) sample = sampler.at(hit + step);
  if (!sample.known) sample = sampler.at(hit - step);
  if (!sample.known) return options.truncation / 3;  // depths less certain are not used
  if (std::abs(sample.mean) > 0.01 * options.voxel) {
    const Sample behind = sampler.at(hit + step);
    if (behind.known && behind.mean <= 0) sample = behind;
    sample.variance += sample.mean * sample.mean;
  }
  return std::sqrt(sample.variance);
}

/// Fetches what is read and written of a ray. Inlined, since GCC removes calls of functions that do nothing but
/// prefetch.
[[gnu::always_inline]] inline void prefetch(const Eigen::Ref<const Eigen::Matrix3Xd>& origins,
                                            const Eigen::Ref<const Eigen::Matrix3Xd>& directions, Eigen::Index i,
                                            const SdfHits& out) {
  const auto* const point = out.point.data() + 3 * i;
  const auto* const normal = out.normal.data() + 3 * i;
  const void* const all[] = {
      origins.col(i).data(), directions.col(i).data(), point, normal, &out.distance[i], &out.sigma[i], &out.hit[i]};
  for (const void* const each : all) __builtin_prefetch(each);
}

/// Entries of rays that do not hit.
void meet_nothing(Eigen::Index first, Eigen::Index last, SdfHits& out) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const Eigen::Index count = last - first;
  std::fill(out.hit.begin() + first, out.hit.begin() + last, std::uint8_t{0});
  out.distance.segment(first, count).setConstant(kNaN);
  out.point.middleCols(first, count).setConstant(kNaN);
  out.normal.middleCols(first, count).setConstant(kNaN);
  out.sigma.segment(first, count).setConstant(kNaN);
}

}  // namespace

void cast_rays(const SdfGrid& grid, CrossingCells& crossing, const Eigen::Ref<const Eigen::Matrix3Xd>& origins,
               const Eigen::Ref<const Eigen::Matrix3Xd>& directions, Eigen::Index first, Eigen::Index last,
               SdfHits& out) {
  meet_nothing(first, last, out);
  SdfSampler sampler(grid);
  std::vector<BlockOnRay> met(last - first);
  std::vector<int> block(last - first);
  for (Eigen::Index i = first; i < last; ++i) {
    const UnitDirection direction(directions.col(i));
    met[i - first] = RayMarch(grid, crossing, sampler, origins.col(i), direction.unit).first_block();
    block[i - first] = met[i - first].block;
  }
  const std::vector<int> order = block_order(block, static_cast<int>(grid.keys.size()));
  for (std::size_t at = 0; at < order.size() && block[order[at]] >= 0; ++at) {
    if (at + kAhead < order.size()) prefetch(origins, directions, first + order[at + kAhead], out);
    const Eigen::Index i = first + order[at];
    const UnitDirection direction(directions.col(i));
    const double t = RayMarch(grid, crossing, sampler, origins.col(i), direction.unit).crossing(met[order[at]]);
    if (std::isnan(t)) continue;
    const Eigen::Vector3d point = origins.col(i) + t * direction.unit, normal = sampler.direction(point);
    out.hit[i] = 1;
    out.distance[i] = t / direction.length;
    out.point.col(i) = point;
    out.normal.col(i) = normal.isZero(0) ? -direction.unit : normal;  // zero at the rim of what was seen
    out.sigma[i] = sigma_at(sampler, point, direction.unit, grid.options);
  }
}

}  // namespace mmgrasp::detail
