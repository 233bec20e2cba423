#include "verify/base/floor.hpp"

#include <algorithm>
#include <cmath>

namespace mmgrasp::verify::detail {

int Floor::layer(double heading) const {
  int nearest = -1;
  double least = kSameHeading;
  for (std::size_t i = 0; i < grid_.headings.size(); ++i) {
    const double apart = std::abs(wrap_angle(heading - grid_.headings[i]));
    if (apart >= least) continue;
    least = apart;
    nearest = static_cast<int>(i);
  }
  return nearest;
}

bool Floor::inside(int region, int layer, int ix, int iy) const {
  if (ix < 0 || iy < 0 || ix >= grid_.nx || iy >= grid_.ny) return false;
  const std::size_t index = (static_cast<std::size_t>(layer) * grid_.ny + iy) * grid_.nx + ix;
  return regions_[region]->cells[index] != 0;
}

bool Floor::any(int region, int layer) const {
  const std::size_t size = static_cast<std::size_t>(grid_.nx) * grid_.ny;
  const auto first = regions_[region]->cells.begin() + static_cast<std::ptrdiff_t>(layer * size);
  return std::any_of(first, first + static_cast<std::ptrdiff_t>(size), [](std::uint8_t cell) { return cell != 0; });
}

double Floor::clearance(int region, int layer, const Eigen::Vector2d& point, double cap) const {
  const Eigen::Vector2d cell = (point - grid_.origin) / grid_.resolution;  // in cells
  const double reach = cap / grid_.resolution;
  if (!cell.allFinite()) return -cap;
  // One ring of cells around the grid stands for all that lies outside.
  const auto index = [](double value, int size) {
    return static_cast<int>(std::floor(std::clamp(value, -1.0, size + 0.5)));
  };
  const int x0 = index(cell.x() - reach, grid_.nx), x1 = index(cell.x() + reach, grid_.nx);
  const int y0 = index(cell.y() - reach, grid_.ny), y1 = index(cell.y() + reach, grid_.ny);
  double to_outside = reach * reach, to_inside = reach * reach;
  if (cell.minCoeff() < 0 || cell.x() > grid_.nx || cell.y() > grid_.ny) to_outside = 0;
  for (int iy = y0; iy <= y1; ++iy) {
    const double dy = std::max({iy - cell.y(), cell.y() - (iy + 1), 0.0});
    for (int ix = x0; ix <= x1; ++ix) {
      const double dx = std::max({ix - cell.x(), cell.x() - (ix + 1), 0.0});
      double& least = inside(region, layer, ix, iy) ? to_inside : to_outside;
      least = std::min(least, dx * dx + dy * dy);
    }
  }
  return (std::sqrt(to_outside) - (to_outside > 0 ? 0.0 : std::sqrt(to_inside))) * grid_.resolution;
}

}  // namespace mmgrasp::verify::detail
