#pragma once

#include <cstdint>
#include <vector>

#include "mmgrasp/task/base_sequence.hpp"

namespace mmgrasp::detail {

/// A grid's cell, as the square [ix, ix + 1] x [iy, iy + 1].
struct Square {
  int ix, iy;
};

/// One tray's region in one layer, cut to its bounds.
struct Patch {
  TrayId tray;
  int x0 = 0, y0 = 0, nx = 0, ny = 0;
  std::vector<std::uint8_t> cells;
  std::vector<Square> border;  ///< Cells outside that touch the region: all that limits a disc.

  bool has(int ix, int iy) const {
    return ix >= x0 && iy >= y0 && ix < x0 + nx && iy < y0 + ny &&
           cells[static_cast<std::size_t>(iy - y0) * nx + ix - x0] != 0;
  }
};

/// All regions, each cut to its bounds, layer by layer: made once, queried often.
class RegionPatches {
 public:
  /// Throws InvalidInput when a region does not fit the grid.
  RegionPatches(const BaseGrid& grid, const std::vector<BaseRegion>& regions);

  const BaseGrid& grid() const { return grid_; }
  /// Trays that have targets, ascending.
  const std::vector<TrayId>& trays() const { return trays_; }
  int headings() const { return static_cast<int>(layers_.size()); }
  /// Patches of the regions that have cells in a layer, by tray.
  const std::vector<Patch>& layer(int heading) const { return layers_[heading]; }

  /// What these trays (ascending) share in a layer, with the widest disc in it; radius 0 when that is nothing.
  Intersection shared(const std::vector<TrayId>& trays, int heading) const;
  /// The same in the layer where the disc is widest.
  Intersection widest(const std::vector<TrayId>& trays) const;

 private:
  BaseGrid grid_;
  std::vector<TrayId> trays_;
  std::vector<std::vector<Patch>> layers_;
};

/// maximal_intersections() without cutting the regions out again.
Intersections maximal_intersections(const RegionPatches& patches, double min_radius, std::size_t max_boxes,
                                    const Monitor& monitor);

}  // namespace mmgrasp::detail
