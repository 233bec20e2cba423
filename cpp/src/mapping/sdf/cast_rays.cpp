#include "mapping/sdf/cast_rays.hpp"

#include <cmath>

#include "mapping/sdf/block_order.hpp"
#include "mapping/sdf/ray_march.hpp"

namespace mmgrasp::detail {

void cast_rays(const SdfGrid& grid, CrossingCells& crossing, const Eigen::Matrix3Xd& origins,
               const Eigen::Matrix3Xd& directions, Eigen::Index first, Eigen::Index last, SdfHits& out) {
  SdfSampler sampler(grid);
  const auto march = [&](Eigen::Index i) {
    return RayMarch(grid, crossing, sampler, origins.col(i), directions.col(i).stableNormalized());
  };
  std::vector<BlockOnRay> met(last - first);
  std::vector<int> block(last - first);
  for (Eigen::Index i = first; i < last; ++i) {
    met[i - first] = march(i).first_block();
    block[i - first] = met[i - first].block;
  }
  for (const int k : block_order(block, static_cast<int>(grid.keys.size()))) {
    if (block[k] < 0) break;  // the others meet none either
    const Eigen::Index i = first + k;
    const double t = march(i).crossing(met[k]);
    if (std::isnan(t)) continue;
    const Eigen::Vector3d way = directions.col(i).stableNormalized(), point = origins.col(i) + t * way;
    const Eigen::Vector3d normal = sampler.direction(point);
    out.hit[i] = 1;
    out.distance[i] = t / directions.col(i).stableNorm();
    out.point.col(i) = point;
    out.normal.col(i) = normal.isZero(0) ? -way : normal;  // zero at the rim of what was seen
    out.sigma[i] = std::sqrt(sampler.at(point).variance);
  }
}

}  // namespace mmgrasp::detail
