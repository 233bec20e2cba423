#include "mapping/sdf/query_points.hpp"

#include <cmath>
#include <limits>

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

/// Columns in the order of their blocks, those of no block last.
std::vector<int> by_block(const SdfGrid& grid, const Eigen::Matrix3Xd& points, Eigen::Index first, Eigen::Index last) {
  const int none = static_cast<int>(grid.keys.size());
  std::vector<int> block(last - first), begin(none + 2, 0), order(last - first);
  SdfSampler sampler(grid);
  for (Eigen::Index i = first; i < last; ++i) {
    const int found = sampler.block_at(points.col(i));
    block[i - first] = found < 0 ? none : found;
    ++begin[block[i - first] + 1];
  }
  for (int k = 0; k <= none; ++k) begin[k + 1] += begin[k];
  for (Eigen::Index i = first; i < last; ++i) order[begin[block[i - first]]++] = static_cast<int>(i - first);
  return order;
}

}  // namespace

void query_points(const SdfGrid& grid, const Eigen::Matrix3Xd& points, Eigen::Index first, Eigen::Index last,
                  SdfValues& out) {
  SdfSampler sampler(grid);
  if (last - first >= kFewestOfBlock * static_cast<Eigen::Index>(grid.keys.size())) {
    // Points in any order miss the cache; block by block they do not.
    const std::vector<int> order = by_block(grid, points, first, last);
    for (std::size_t k = 0; k < order.size(); ++k) {
      if (k + kAhead < order.size()) __builtin_prefetch(points.data() + 3 * (first + order[k + kAhead]));
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
