#include "mmgrasp/task/base_region.hpp"

#include <algorithm>

#include "task/base_region/region_search.hpp"

namespace mmgrasp {

std::size_t BaseRegion::count() const {
  return std::count(cells.begin(), cells.end(), std::uint8_t{1});
}

std::vector<BaseRegion> compute_base_regions(const PartSupplyProblem& problem, const ReachDatabase& database,
                                             const BaseGrid& grid, const Monitor& monitor) {
  return detail::compute_base_regions(problem, database, grid, BasePoseEvaluator(problem, database), monitor);
}

namespace detail {
namespace {

constexpr std::size_t kPartsAtOnce = 4096;  // Bounds the memory that base poses not yet judged take.

}  // namespace

std::vector<BaseRegion> compute_base_regions(const PartSupplyProblem& problem, const ReachDatabase& database,
                                             const BaseGrid& grid, const BasePoseEvaluator& evaluator,
                                             const Monitor& monitor) {
  RegionSearch search(problem, database, grid, evaluator, false);
  std::vector<BaseRegion> regions;
  for (int first = 0, last = 0; first < search.trays(); first = last) {
    std::size_t parts = 0;
    do {
      parts += search.parts(TrayId(last++)).size();
    } while (last < search.trays() && parts + search.parts(TrayId(last)).size() <= kPartsAtOnce);
    if (!search.run(first, last, monitor)) return {};
    for (int index = first; index < last; ++index) {
      const TrayId tray(index);
      regions.push_back(search.region(tray));
      search.forget(tray);
    }
  }
  return regions;
}

}  // namespace detail
}  // namespace mmgrasp
