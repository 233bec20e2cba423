#include "mmgrasp/task/base_region.hpp"

#include <algorithm>

#include "mmgrasp/core/error.hpp"
#include "task/base_region/region_search.hpp"
#include "task/base_region/search_area.hpp"
#include "task/problem/scene.hpp"

namespace mmgrasp {

std::size_t BaseRegion::count() const {
  return std::count(cells.begin(), cells.end(), std::uint8_t{1});
}

std::vector<BaseRegion> compute_base_regions(const PartSupplyProblem& problem, const ReachDatabase& database,
                                             const BaseGrid& grid, const Monitor& monitor) {
  return detail::compute_base_regions(problem, database, grid, BasePoseEvaluator(problem, database), monitor);
}

std::vector<BaseRegion> share_headings(const PartSupplyProblem& problem, const ReachDatabase& database,
                                       const BaseGrid& grid, std::vector<BaseRegion> regions, const Monitor& monitor) {
  return detail::share_headings(problem, database, grid, std::move(regions), BasePoseEvaluator(problem, database),
                                monitor);
}

namespace detail {
namespace {

constexpr std::size_t kPartsAtOnce = 4096;  // Bounds the memory that base poses not yet judged take.

/// Runs the search for some trays at a time and hands over the region of each, in their order. False when stopped.
template <class Take>
bool search_trays(RegionSearch& search, const Monitor& monitor, const Take& take) {
  for (int first = 0, last = 0; first < search.trays(); first = last) {
    std::size_t parts = 0;
    do {
      parts += search.parts(TrayId(last++)).size();
    } while (last < search.trays() && parts + search.parts(TrayId(last)).size() <= kPartsAtOnce);
    if (!search.run(first, last, monitor)) return false;
    for (int index = first; index < last; ++index) {
      const TrayId tray(index);
      take(tray, search.region(tray));
      search.forget(tray);
    }
  }
  return true;
}

/// Where a tray can be served at a heading of its own.
CellMask served_at_own_headings(const PartSupplyProblem& problem, const BaseGrid& grid,
                                const std::vector<BaseRegion>& regions) {
  CellMask served(grid.size(), 0);
  const std::size_t layer_size = static_cast<std::size_t>(grid.nx) * grid.ny;
  for (TrayId tray : all_trays(problem)) {
    for (int layer : tray_layers(grid, tray_of(problem, tray))) {
      const std::size_t first = layer * layer_size;
      for (std::size_t i = first; i < first + layer_size; ++i) served[i] |= regions[tray].cells[i];
    }
  }
  return served;
}

void add(BaseRegion& region, const BaseRegion& more) {
  for (std::size_t i = 0; i < region.cells.size(); ++i) region.cells[i] |= more.cells[i];
  for (std::size_t part = 0; part < region.part_cells.size(); ++part) {
    for (const PartCells::Window& w : more.part_cells[part].windows())
      region.part_cells[part].add_window(w.heading, w.x0, w.y0, w.nx, w.ny, w.flags);
    PartExplanation& explanation = region.explanations[part];
    explanation.base_poses_tried += more.explanations[part].base_poses_tried;
    explanation.base_poses_feasible += more.explanations[part].base_poses_feasible;
    explanation.rejections += more.explanations[part].rejections;
  }
}

}  // namespace

std::vector<BaseRegion> compute_base_regions(const PartSupplyProblem& problem, const ReachDatabase& database,
                                             const BaseGrid& grid, const BasePoseEvaluator& evaluator,
                                             const Monitor& monitor) {
  RegionSearch search(problem, database, grid, evaluator, false);
  std::vector<BaseRegion> regions;
  const auto take = [&](TrayId, BaseRegion region) { regions.push_back(std::move(region)); };
  if (!search_trays(search, monitor, take)) return {};
  return regions;
}

std::vector<BaseRegion> share_headings(const PartSupplyProblem& problem, const ReachDatabase& database,
                                       const BaseGrid& grid, std::vector<BaseRegion> regions,
                                       const BasePoseEvaluator& evaluator, const Monitor& monitor) {
  require(regions.size() == problem.trays.size(), "regions", regions.size(), "must be one for each tray");
  for (const BaseRegion& region : regions)
    require(region.cells.size() == grid.size(), "regions", region.cells.size(), "must have the grid's cells");
  for (TrayId tray : all_trays(problem)) {
    const std::size_t parts = regions[tray].part_cells.size(), targets = target_parts(problem, tray).size();
    require(parts == 0 || parts == targets, "regions", parts, "must have the problem's target parts");
    require(regions[tray].explanations.size() == parts, "regions", parts, "must explain each of their parts");
  }
  if (grid.headings.size() < 2) return regions;
  RegionSearch search(problem, database, grid, evaluator, served_at_own_headings(problem, grid, regions));
  const auto take = [&](TrayId tray, const BaseRegion& more) { add(regions[tray], more); };
  if (!search_trays(search, monitor, take)) return {};
  return regions;
}

}  // namespace detail
}  // namespace mmgrasp
