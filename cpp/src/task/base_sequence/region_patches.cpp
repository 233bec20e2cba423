#include "task/base_sequence/region_patches.hpp"

#include <algorithm>

#include "mmgrasp/core/error.hpp"
#include "task/base_sequence/inscribed_circle.hpp"

namespace mmgrasp::detail {
namespace {

Patch make_patch(const BaseGrid& grid, const CellMask& mask, int heading, TrayId tray) {
  Patch patch;
  patch.tray = tray;
  int x1 = -1, y1 = -1;
  patch.x0 = grid.nx;
  patch.y0 = grid.ny;
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < grid.nx; ++ix) {
      if (!mask[grid.index(heading, ix, iy)]) continue;
      patch.x0 = std::min(patch.x0, ix);
      patch.y0 = std::min(patch.y0, iy);
      x1 = std::max(x1, ix);
      y1 = std::max(y1, iy);
    }
  }
  if (x1 < 0) return patch;
  patch.nx = x1 - patch.x0 + 1;
  patch.ny = y1 - patch.y0 + 1;
  patch.cells.reserve(static_cast<std::size_t>(patch.nx) * patch.ny);
  for (int iy = patch.y0; iy <= y1; ++iy) {
    for (int ix = patch.x0; ix <= x1; ++ix) patch.cells.push_back(mask[grid.index(heading, ix, iy)] ? 1 : 0);
  }
  for (int iy = patch.y0 - 1; iy <= y1 + 1; ++iy) {
    for (int ix = patch.x0 - 1; ix <= x1 + 1; ++ix) {
      bool touches = false;
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) touches = touches || patch.has(ix + dx, iy + dy);
      }
      if (touches && !patch.has(ix, iy)) patch.border.push_back({ix, iy});
    }
  }
  return patch;
}

}  // namespace

RegionPatches::RegionPatches(const BaseGrid& grid, const std::vector<BaseRegion>& regions)
    : grid_(grid), layers_(grid.headings.size()) {
  for (int tray = 0; tray < static_cast<int>(regions.size()); ++tray) {
    const BaseRegion& region = regions[tray];
    if (!region.has_targets) continue;
    trays_.emplace_back(tray);
    require(region.cells.size() == grid.size(), "region '" + region.tray + "' cells",
            static_cast<double>(region.cells.size()),
            "must be one flag a cell of the grid (" + std::to_string(grid.size()) + ")");
  }
  for (int heading = 0; heading < headings(); ++heading) {
    for (TrayId tray : trays_) {
      Patch patch = make_patch(grid, regions[tray].cells, heading, tray);
      if (!patch.cells.empty()) layers_[heading].push_back(std::move(patch));
    }
  }
}

Intersection RegionPatches::shared(const std::vector<TrayId>& trays, int heading) const {
  Intersection place;
  place.trays = trays;
  place.heading = heading;
  const std::vector<Patch>& patches = layer(heading);
  std::vector<const Patch*> some;
  int x0 = 0, y0 = 0, x1 = grid_.nx, y1 = grid_.ny;
  for (const TrayId tray : trays) {
    const auto found = std::lower_bound(patches.begin(), patches.end(), tray,
                                        [](const Patch& patch, TrayId wanted) { return patch.tray < wanted; });
    if (found == patches.end() || found->tray != tray) return place;
    some.push_back(&*found);
    x0 = std::max(x0, found->x0);
    y0 = std::max(y0, found->y0);
    x1 = std::min(x1, found->x0 + found->nx);
    y1 = std::min(y1, found->y0 + found->ny);
  }
  if (x0 >= x1 || y0 >= y1) return place;
  std::vector<std::uint8_t> cells;
  for (int iy = y0; iy < y1; ++iy) {
    for (int ix = x0; ix < x1; ++ix) {
      const bool all = std::all_of(some.begin(), some.end(), [&](const Patch* p) { return p->has(ix, iy); });
      cells.push_back(all ? 1 : 0);
      place.cells += all ? 1 : 0;
    }
  }
  const InscribedCircle circle = inscribed_circle_in_cells(x1 - x0, y1 - y0, cells, kCircleError / grid_.resolution);
  place.radius = circle.radius * grid_.resolution;
  place.centre = grid_.origin + (circle.centre + Eigen::Vector2d(x0, y0)) * grid_.resolution;
  return place;
}

Intersection RegionPatches::widest(const std::vector<TrayId>& trays) const {
  Intersection best;
  for (int heading = 0; heading < headings(); ++heading) {
    Intersection place = shared(trays, heading);
    if (heading == 0 || place.radius > best.radius) best = std::move(place);
  }
  return best;
}

}  // namespace mmgrasp::detail
