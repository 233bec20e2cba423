#include "task/part_supply/plan_intersections.hpp"

#include <algorithm>
#include <cmath>

namespace mmgrasp::detail {
namespace {

constexpr std::size_t kListedSets = 2000;

Intersection intersection_of(const Stop& stop, const BaseGrid& grid, const std::vector<BaseRegion>& regions) {
  Intersection own;
  own.trays = stop.trays;
  own.centre = stop.pose.head<2>();
  own.radius = stop.radius;
  while (grid.headings[own.heading] != stop.pose.z()) ++own.heading;
  for (std::size_t cell = 0; cell < static_cast<std::size_t>(grid.cells_per_layer()); ++cell) {
    const std::size_t at = grid.index(own.heading, 0, 0) + cell;
    own.cells +=
        std::all_of(own.trays.begin(), own.trays.end(), [&](TrayId tray) { return regions[tray].cells[at] != 0; });
  }
  return own;
}

}  // namespace

Intersections plan_intersections(const BaseGrid& grid, const std::vector<BaseRegion>& regions, double min_radius,
                                 Intersections candidates, std::vector<Stop>& stops) {
  Intersections result = robust_intersections(grid, regions, min_radius, kListedSets);
  if (!result.complete) result = std::move(candidates);
  std::vector<Intersection>& robust = result.robust;
  for (Stop& stop : stops) {
    const auto same = std::find_if(robust.begin(), robust.end(), [&](const Intersection& some) {
      return some.trays == stop.trays && std::abs(grid.headings[some.heading] - stop.pose.z()) < 1e-12;
    });
    stop.intersection = static_cast<int>(same - robust.begin());
    if (same == robust.end()) robust.push_back(intersection_of(stop, grid, regions));
  }
  return result;
}

}  // namespace mmgrasp::detail
