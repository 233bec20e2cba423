#include "mapping/sdf/query_points.hpp"

#include <cmath>
#include <limits>

#include "mapping/sdf/block_order.hpp"
#include "mapping/sdf/sdf_sampler.hpp"

namespace mmgrasp::detail {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr int kAhead = 16;         // points that are fetched before they are needed
constexpr int kFewestOfBlock = 2;  // points a block, in the mean, from which sorting pays

void answer(SdfSampler& sampler, const Eigen::Matrix3Xd& points, Eigen::Index i, SdfValues& out) {
  const Sample sample = sampler.at(points.col(i));
  out.mean[i] = sample.known ? sample.mean : kNaN;
  out.sigma[i] = sample.known ? std::sqrt(sample.variance) : kNaN;
  out.known[i] = sample.known;
}

/// Fetches what is read and written of a point.
void prefetch(const Eigen::Matrix3Xd& points, Eigen::Index i, const SdfValues& out) {
  __builtin_prefetch(points.data() + 3 * i);
  __builtin_prefetch(&out.mean[i], 1);
  __builtin_prefetch(&out.sigma[i], 1);
  __builtin_prefetch(&out.known[i], 1);
}

}  // namespace

void query_points(const SdfGrid& grid, const Eigen::Matrix3Xd& points, Eigen::Index first, Eigen::Index last,
                  SdfValues& out) {
  SdfSampler sampler(grid);
  if (last - first >= kFewestOfBlock * static_cast<Eigen::Index>(grid.keys.size())) {
    std::vector<int> block(last - first);
    for (Eigen::Index i = first; i < last; ++i) block[i - first] = sampler.block_at(points.col(i));
    const std::vector<int> order = block_order(block, static_cast<int>(grid.keys.size()));
    for (std::size_t k = 0; k < order.size(); ++k) {
      if (k + kAhead < order.size()) prefetch(points, first + order[k + kAhead], out);
      answer(sampler, points, first + order[k], out);
    }
    return;
  }
  SdfSampler ahead(grid);
  for (Eigen::Index i = first; i < last; ++i) {
    if (i + kAhead < last) ahead.prefetch(points.col(i + kAhead));
    answer(sampler, points, i, out);
  }
}

}  // namespace mmgrasp::detail
