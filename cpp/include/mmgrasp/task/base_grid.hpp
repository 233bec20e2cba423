#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/task/problem.hpp"

namespace mmgrasp {

/// Square cells over the floor, one layer for each heading; all trays share one grid so that regions intersect cell by
/// cell.
struct MMGRASP_EXPORT BaseGrid {
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< Lower corner of cell (0, 0) [m].
  double resolution = 0.05;                          ///< Cell edge [m].
  int nx = 0, ny = 0;                                ///< Cells of a layer along x and y.
  std::vector<double> headings;                      ///< Heading of each layer [rad]; distinct.

  int cells_per_layer() const { return nx * ny; }
  std::size_t size() const { return headings.size() * static_cast<std::size_t>(nx) * ny; }
  std::size_t index(int heading, int ix, int iy) const {
    return (static_cast<std::size_t>(heading) * ny + iy) * nx + ix;
  }
  Eigen::Vector3d centre(int heading, int ix, int iy) const;  ///< Base pose (x, y, theta) in the middle of a cell.
};

/// One flag a cell of a BaseGrid.
using CellMask = std::vector<std::uint8_t>;

/// The grid that covers all base poses from which any tray could be reached.
MMGRASP_EXPORT BaseGrid make_base_grid(const PartSupplyProblem& problem, const ReachDatabase& database);

}  // namespace mmgrasp
