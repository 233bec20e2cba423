#include "mmgrasp/task/base_grid.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "mmgrasp/core/error.hpp"
#include "task/base_region/search_area.hpp"

namespace mmgrasp {
namespace {

constexpr double kMaxCells = 2e7;

bool has_targets(const Tray& tray) {
  return std::any_of(tray.parts.begin(), tray.parts.end(), [](const Part& part) { return part.target; });
}

}  // namespace

Eigen::Vector3d BaseGrid::centre(int heading, int ix, int iy) const {
  return Eigen::Vector3d(origin.x() + (ix + 0.5) * resolution, origin.y() + (iy + 0.5) * resolution, headings[heading]);
}

BaseGrid make_base_grid(const PartSupplyProblem& problem, const ReachDatabase& database) {
  BaseGrid grid;
  grid.resolution = problem.options.grid.resolution;
  Eigen::AlignedBox2d box;
  for (const Tray& tray : problem.trays) {
    if (!has_targets(tray)) continue;
    for (double heading : detail::tray_headings(tray)) detail::add_heading(grid.headings, heading);
    const Eigen::Vector2d middle = tray.T_world_tray.translation().head<2>();
    const Eigen::Vector2d radius = Eigen::Vector2d::Constant(detail::base_search_radius(problem, tray, database));
    box.extend(Eigen::Vector2d(middle - radius));
    box.extend(Eigen::Vector2d(middle + radius));
  }
  if (box.isEmpty()) return grid;
  // Cell corners lie on multiples of the resolution: moving one tray does not shift the grid under the others.
  const auto down = [&](double v) { return std::floor(v / grid.resolution + 1e-9); };
  const auto up = [&](double v) { return std::ceil(v / grid.resolution - 1e-9); };
  const Eigen::Vector2d cells(up(box.max().x()) - down(box.min().x()), up(box.max().y()) - down(box.min().y()));
  if (!(cells.prod() * static_cast<double>(grid.headings.size()) <= kMaxCells)) {
    char wide[96];
    std::snprintf(wide, sizeof(wide), "grid.resolution = %g: %.0f x %.0f cells", grid.resolution, cells.x(), cells.y());
    throw InvalidInput(std::string(wide) + " in " + std::to_string(grid.headings.size()) +
                       " headings are more than 20 million: list fewer headings of trays, raise grid_resolution, lower "
                       "grid_max_distance, or plan for trays that are nearer to each other");
  }
  grid.origin = Eigen::Vector2d(down(box.min().x()), down(box.min().y())) * grid.resolution;
  grid.nx = static_cast<int>(cells.x());
  grid.ny = static_cast<int>(cells.y());
  return grid;
}

}  // namespace mmgrasp
