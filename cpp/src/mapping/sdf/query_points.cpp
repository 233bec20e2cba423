#include "mapping/sdf/query_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "mapping/sdf/block_order.hpp"
#include "mapping/sdf/sdf_sampler.hpp"

namespace mmgrasp::detail {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr Eigen::Index kFewestOfBlock = 4;  // points a block, in the mean, from which sorting pays
constexpr Eigen::Index kGroup = 64;         // points whose voxels are fetched at once

/// A point whose voxels are on their way.
struct PointAhead {
  explicit PointAhead(const SdfGrid& grid) : around(grid) {}
  PlaceInCell place{};
  unsigned neighbours = 0;  ///< None: it lies in no cell.
  BlockNeighbours around;
};

void write(const Sample& sample, Eigen::Index i, SdfValues& out) {
  out.mean[i] = sample.known ? sample.mean : kNaN;
  out.sigma[i] = sample.known ? std::sqrt(sample.variance) : kNaN;
  out.known[i] = sample.known;
}

/// What a work item is: some of the points, and where their answers go.
struct Piece {
  const SdfGrid& grid;
  const Eigen::Ref<const Eigen::Matrix3Xd>& points;
  Eigen::Index first, last;
  SdfValues& out;
};

/// Fetches what is read and written of a point. Inlined, since GCC removes calls of functions that do nothing but
/// prefetch.
[[gnu::always_inline]] inline void prefetch(const Piece& piece, Eigen::Index i) {
  __builtin_prefetch(piece.points.data() + 3 * i);
  __builtin_prefetch(&piece.out.mean[i], 1);
  __builtin_prefetch(&piece.out.sigma[i], 1);
  __builtin_prefetch(&piece.out.known[i], 1);
}

/// Points one block after the other, whose voxels are read once.
void by_block(const Piece& piece) {
  constexpr std::size_t kAhead = 16;  // points that are fetched before they are needed
  SdfSampler sampler(piece.grid);
  std::vector<int> block(piece.last - piece.first);
  for (Eigen::Index i = piece.first; i < piece.last; ++i)
    block[i - piece.first] = sampler.block_at(piece.points.col(i));
  const std::vector<int> order = block_order(block, static_cast<int>(piece.grid.keys.size()));
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (k + kAhead < order.size()) prefetch(piece, piece.first + order[k + kAhead]);
    const Eigen::Index i = piece.first + order[k];
    write(sampler.at(piece.points.col(i)), i, piece.out);
  }
}

/// Points in their order. Where a map is larger than the caches almost all time goes into waiting: each step reads what
/// the one before fetched for all points of a group.
void by_group(const Piece& piece) {
  const SdfSampler sampler(piece.grid);
  std::vector<PointAhead> ahead(std::min(kGroup, piece.last - piece.first), PointAhead(piece.grid));
  for (Eigen::Index first = piece.first; first < piece.last; first += kGroup) {
    const Eigen::Index count = std::min(kGroup, piece.last - first);
    for (Eigen::Index k = 0; k < count; ++k) {
      PointAhead& point = ahead[k];
      point.neighbours = sampler.find_cell(piece.points.col(first + k), point.place) ? point.place.neighbours() : 0;
      point.around.enter(point.place.block());
      point.around.fetch_slots(point.neighbours);
    }
    for (Eigen::Index k = 0; k < count; ++k) ahead[k].around.find_blocks(ahead[k].neighbours);
    for (Eigen::Index k = 0; k < count; ++k) {
      ahead[k].around.find_voxels(ahead[k].neighbours);
      if (ahead[k].neighbours != 0) sampler.fetch_voxels(ahead[k].place, ahead[k].neighbours, ahead[k].around);
    }
    for (Eigen::Index k = 0; k < count; ++k) {
      write(ahead[k].neighbours != 0 ? sampler.at(ahead[k].place, ahead[k].around) : Sample{}, first + k, piece.out);
    }
  }
}

}  // namespace

void query_points(const SdfGrid& grid, const Eigen::Ref<const Eigen::Matrix3Xd>& points, Eigen::Index first,
                  Eigen::Index last, SdfValues& out) {
  const Piece piece{grid, points, first, last, out};
  const bool many = last - first >= kFewestOfBlock * static_cast<Eigen::Index>(grid.keys.size());
  many ? by_block(piece) : by_group(piece);
}

}  // namespace mmgrasp::detail
