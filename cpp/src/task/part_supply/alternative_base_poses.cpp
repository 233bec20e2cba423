#include "task/part_supply/alternative_base_poses.hpp"

#include <algorithm>
#include <cmath>

namespace mmgrasp::detail {
namespace {

/// Distance from a point to the cells that are not marked, and to the grid's end.
double clearance(const BaseGrid& grid, const CellMask& shared, int heading, const Eigen::Vector2d& p) {
  const double h = grid.resolution;
  const Eigen::Vector2d low = p - grid.origin;
  double least = std::min({low.x(), low.y(), grid.nx * h - low.x(), grid.ny * h - low.y()});
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < grid.nx; ++ix) {
      if (shared[grid.index(heading, ix, iy)]) continue;
      const double dx = std::max({ix * h - low.x(), 0.0, low.x() - (ix + 1) * h});
      const double dy = std::max({iy * h - low.y(), 0.0, low.y() - (iy + 1) * h});
      least = std::min(least, std::hypot(dx, dy));
    }
  }
  return least;
}

int layer_of(const BaseGrid& grid, const Stop& stop) {
  int heading = 0;
  while (heading < static_cast<int>(grid.headings.size()) &&
         std::abs(wrap_angle(grid.headings[heading] - stop.pose.z())) > 1e-9) {
    ++heading;
  }
  return heading;
}

CellMask shared_cells(const BaseGrid& grid, const std::vector<BaseRegion>& regions, const Stop& stop) {
  CellMask shared(grid.size(), 1);
  for (TrayId tray : stop.trays) {
    for (std::size_t i = 0; i < shared.size(); ++i) shared[i] = shared[i] && regions[tray].cells[i];
  }
  return shared;
}

}  // namespace

double room_around(const BaseGrid& grid, const std::vector<BaseRegion>& regions, const Stop& stop) {
  return clearance(grid, shared_cells(grid, regions, stop), layer_of(grid, stop), stop.pose.head<2>());
}

std::vector<Stop> alternative_base_poses(const BaseGrid& grid, const std::vector<BaseRegion>& regions, const Stop& stop,
                                         double min_radius, double apart, std::size_t count) {
  const int heading = layer_of(grid, stop);
  if (heading == static_cast<int>(grid.headings.size())) return {};
  const CellMask shared = shared_cells(grid, regions, stop);
  std::vector<Stop> candidates;
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < grid.nx; ++ix) {
      if (!shared[grid.index(heading, ix, iy)]) continue;
      Stop other = stop;
      other.pose = grid.centre(heading, ix, iy);
      other.radius = clearance(grid, shared, heading, other.pose.head<2>());
      if (other.radius >= min_radius) candidates.push_back(other);
    }
  }
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Stop& a, const Stop& b) { return a.radius > b.radius; });
  std::vector<Stop> chosen;
  for (const Stop& place : candidates) {
    bool is_far = (place.pose - stop.pose).head<2>().norm() >= apart;
    for (const Stop& other : chosen) is_far = is_far && (place.pose - other.pose).head<2>().norm() >= apart;
    if (is_far) chosen.push_back(place);
    if (chosen.size() == count) break;
  }
  return chosen;
}

}  // namespace mmgrasp::detail
