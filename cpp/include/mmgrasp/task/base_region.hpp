#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/core/outcome.hpp"
#include "mmgrasp/task/problem.hpp"

namespace mmgrasp {

/// Square cells over the floor, one layer for each heading; all trays share one grid so that regions intersect cell by cell.
struct MMGRASP_EXPORT BaseGrid {
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< Lower corner of cell (0, 0) [m].
  double resolution = 0.05;
  int nx = 0, ny = 0;
  std::vector<double> headings;                      ///< [rad], distinct.

  int cells_per_layer() const { return nx * ny; }
  std::size_t size() const { return headings.size() * static_cast<std::size_t>(nx) * ny; }
  std::size_t index(int heading, int ix, int iy) const {
    return (static_cast<std::size_t>(heading) * ny + iy) * nx + ix;
  }
  Eigen::Vector3d centre(int heading, int ix, int iy) const;  ///< (x, y, theta)
};

/// One flag a cell of a BaseGrid.
using CellMask = std::vector<std::uint8_t>;

/// What became of the candidates for one part, over all base poses tried (counts of grasp x base pose).
struct MMGRASP_EXPORT PartExplanation {
  std::string part;
  int grasps = 0;                     ///< Candidates.
  std::size_t base_poses_tried = 0;
  std::size_t base_poses_feasible = 0;  ///< Base poses from which the part has a collision-free grasp.
  Rejections rejections;              ///< Grasp x base pose pairs by the cause that turned them down.
};

struct MMGRASP_EXPORT BaseRegion {
  std::string tray;
  CellMask cells;                     ///< 1: from everywhere in this cell every target part can be grasped.
  std::vector<CellMask> part_cells;   ///< The same for each target part alone, in the tray's order.
  std::vector<PartExplanation> explanations;
  std::size_t base_poses_in_collision = 0;  ///< Base poses at which the robot at home touches the scene.
  std::size_t count() const;
};

/// The grid that covers all base poses from which any tray could be reached.
MMGRASP_EXPORT BaseGrid make_base_grid(const PartSupplyProblem& problem, const ReachDatabase& database);

/// P1 Algorithm 2, with exact IK: a base pose is feasible when every target part has a grasp with a collision-free arm
/// configuration (all parts still in place, fingers at the pre-grasp opening) and the robot at home is free there. A tray
/// without target parts gives an empty region, and so does a part without grasps. A cell belongs to the region when its centre and
/// its four corners are feasible, so that the guarantee holds between cell centres too. Same answer at any thread count.
MMGRASP_EXPORT std::vector<BaseRegion> compute_base_regions(const PartSupplyProblem& problem,
                                                            const ReachDatabase& database, const BaseGrid& grid,
                                                            const Monitor& monitor = {});

}  // namespace mmgrasp
