#include <algorithm>
#include <cmath>

#include "task/base_region/base_grid.hpp"

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/task/base_region.hpp"

namespace mmgrasp {
namespace {

constexpr double kSameHeading = 1e-9;  // [rad]

void add_heading(std::vector<double>& headings, double heading) {
  for (double known : headings) {
    if (std::abs(wrap_angle(known - heading)) < kSameHeading) return;
  }
  headings.push_back(wrap_angle(heading));
}

bool has_targets(const Tray& tray) {
  return std::any_of(tray.parts.begin(), tray.parts.end(), [](const Part& part) { return part.target; });
}

}  // namespace

std::vector<double> tray_headings(const Tray& tray) {
  std::vector<double> headings;
  for (double heading : tray.headings) add_heading(headings, heading);
  if (headings.empty()) {
    const Eigen::Vector3d front = tray.T_world_tray.linear().col(0);
    headings.push_back(wrap_angle(std::atan2(front.y(), front.x())));
  }
  return headings;
}

double base_search_radius(const PartSupplyProblem& problem, const Tray& tray, const ReachDatabase& database) {
  if (problem.options.grid.max_distance > 0) return problem.options.grid.max_distance;
  // Half the tray's diagonal, so that a part in its far corner still counts.
  return database.reach() + 0.5 * tray.size.head<2>().norm();
}

BaseGrid make_base_grid(const PartSupplyProblem& problem, const ReachDatabase& database) {
  BaseGrid grid;
  grid.resolution = problem.options.grid.resolution;
  Eigen::AlignedBox2d box;
  for (const Tray& tray : problem.trays) {
    if (!has_targets(tray)) continue;
    for (double heading : tray_headings(tray)) add_heading(grid.headings, heading);
    const Eigen::Vector2d middle = tray.T_world_tray.translation().head<2>();
    const Eigen::Vector2d radius = Eigen::Vector2d::Constant(base_search_radius(problem, tray, database));
    box.extend(Eigen::Vector2d(middle - radius));
    box.extend(Eigen::Vector2d(middle + radius));
  }
  if (box.isEmpty()) return grid;
  // Cell corners lie on multiples of the resolution: moving one tray does not shift the grid under the others.
  const auto down = [&](double v) { return std::floor(v / grid.resolution + 1e-9); };
  const auto up = [&](double v) { return std::ceil(v / grid.resolution - 1e-9); };
  const Eigen::Vector2d cells(up(box.max().x()) - down(box.min().x()), up(box.max().y()) - down(box.min().y()));
  constexpr double kMostCells = 2e7;
  require(cells.prod() * static_cast<double>(grid.headings.size()) <= kMostCells, "grid.resolution", grid.resolution,
          "must be coarser: the base grid would have more than 20 million cells");
  grid.origin = Eigen::Vector2d(down(box.min().x()), down(box.min().y())) * grid.resolution;
  grid.nx = static_cast<int>(cells.x());
  grid.ny = static_cast<int>(cells.y());
  return grid;
}

}  // namespace mmgrasp
