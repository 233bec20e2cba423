#include "mmgrasp/task/base_region.hpp"

#include "task/base_region/region_search.hpp"

namespace mmgrasp {
namespace {

constexpr std::size_t kPartsAtOnce = 4096;  // Bounds the memory that base poses not yet judged take.

}  // namespace

std::vector<BaseRegion> compute_base_regions(const PartSupplyProblem& problem, const ReachDatabase& database,
                                             const BaseGrid& grid, const Monitor& monitor) {
  RegionSearch search(problem, database, grid, false);
  std::vector<BaseRegion> regions;
  for (int first = 0, last = 0; first < search.trays(); first = last) {
    std::size_t parts = 0;
    do {
      parts += search.parts(last++).size();
    } while (last < search.trays() && parts + search.parts(last).size() <= kPartsAtOnce);
    if (!search.run(first, last, monitor)) return {};
    for (int tray = first; tray < last; ++tray) {
      regions.push_back(search.region(tray));
      search.forget(tray);
    }
  }
  return regions;
}

}  // namespace mmgrasp
