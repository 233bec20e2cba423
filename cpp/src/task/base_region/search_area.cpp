#include "task/base_region/search_area.hpp"

#include <cmath>

namespace mmgrasp::detail {

void add_heading(std::vector<double>& headings, double heading) {
  for (double known : headings) {
    if (std::abs(wrap_angle(known - heading)) < kSameHeading) return;
  }
  headings.push_back(wrap_angle(heading));
}

std::vector<double> tray_headings(const Tray& tray) {
  std::vector<double> headings;
  for (double heading : tray.headings) add_heading(headings, heading);
  if (headings.empty()) {
    const Eigen::Vector3d front = tray.T_world_tray.linear().col(0);
    headings.push_back(wrap_angle(std::atan2(front.y(), front.x())));
  }
  return headings;
}

std::vector<int> tray_layers(const BaseGrid& grid, const Tray& tray) {
  std::vector<int> layers;
  for (double wanted : tray_headings(tray)) {
    for (int layer = 0; layer < static_cast<int>(grid.headings.size()); ++layer) {
      if (std::abs(wrap_angle(grid.headings[layer] - wanted)) >= kSameHeading) continue;
      layers.push_back(layer);
      break;
    }
  }
  return layers;
}

double base_search_radius(const PartSupplyProblem& problem, const Tray& tray, const ReachDatabase& database) {
  if (problem.options.grid.max_distance > 0) return problem.options.grid.max_distance;
  // Half the tray's diagonal, so that a part in its far corner still counts.
  return database.reach() + 0.5 * tray.size.head<2>().norm();
}

}  // namespace mmgrasp::detail
