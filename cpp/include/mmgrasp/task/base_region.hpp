#pragma once

#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/core/outcome.hpp"
#include "mmgrasp/task/base_grid.hpp"
#include "mmgrasp/task/part_cells.hpp"
#include "mmgrasp/task/problem.hpp"

namespace mmgrasp {

/// What became of the candidate grasps for one part, over all base poses tried.
///
/// The rejections count grasp x base pose pairs at the base poses from which the part cannot be grasped: there every
/// grasp was rejected, each for one cause, so that their total is grasps x (base_poses_tried - base_poses_feasible).
/// Where one grasp works the others are not tried. The cause of a pair is the last filter that any of its arm
/// configurations got to:
/// - unreachable, limits, self-collision, scene: in this order;
/// - `grasp_filter`: the open hand alone touches the scene or a part at the grasp, whatever the arm does.
struct MMGRASP_EXPORT PartExplanation {
  std::string part;
  int grasps = 0;  ///< Number of candidates.
  /// Centres of cells within the search radius, and corners of those cells whose centre is feasible for the part;
  /// without the base poses at which the robot at home touches the scene.
  std::size_t base_poses_tried = 0;
  std::size_t base_poses_feasible = 0;  ///< Base poses from which the part has a collision-free grasp.
  Rejections rejections;                ///< Grasp x base pose pairs by the cause that rejected them.
};

/// The base poses from which every target part of a tray can be grasped.
struct MMGRASP_EXPORT BaseRegion {
  std::string tray;
  bool has_targets = true;            ///< False: there is nothing to pick, and no stop has to serve the tray.
  CellMask cells;                     ///< 1: from everywhere in this cell every target part can be grasped.
  std::vector<PartCells> part_cells;  ///< The same for each target part alone, in the tray's order.
  std::vector<PartExplanation> explanations;
  /// Cell centres within the search radius at which the robot at home touches the scene.
  std::size_t base_poses_in_collision = 0;
  std::size_t count() const;  ///< Number of cells.
};

/// Where the base can stand to pick every target part of a tray: the base region of each tray (P1 Algorithm 2, with
/// exact IK), one a tray in the problem's order.
///
/// A base pose is feasible when every target part has a grasp with a collision-free arm configuration (all parts still
/// in place, fingers at the pre-grasp opening) and the robot at home is free there. A cell belongs to the region when
/// its centre and its four corners are feasible, so that the guarantee holds between cell centres too. A tray without
/// target parts gives an empty region, and so does a part without grasps. Same answer at any thread count. Empty when
/// the monitor ended it; throws InvalidInput for a database of another arm.
/// @code
///   const BaseGrid grid = make_base_grid(problem, database);
///   for (const BaseRegion& region : compute_base_regions(problem, database, grid))
///     std::cout << region.tray << ": " << region.count() << " cells\n";
/// @endcode
MMGRASP_EXPORT std::vector<BaseRegion> compute_base_regions(const PartSupplyProblem& problem,
                                                            const ReachDatabase& database, const BaseGrid& grid,
                                                            const Monitor& monitor = {});

/// Adds to the regions what neighbours share: a tray that lists no headings (Tray::headings) is also tried at those of
/// the other trays, in the cells where one of these can be served at its own heading. So trays that face each other get
/// stops in common. Cells that no tray's own heading serves are not tried. `regions`: of compute_base_regions() for the
/// same problem and grid. Same answer at any thread count; empty when the monitor ended it; InvalidInput for regions of
/// another problem or grid. P1 3.3 has one heading for each tray.
MMGRASP_EXPORT std::vector<BaseRegion> share_headings(const PartSupplyProblem& problem, const ReachDatabase& database,
                                                      const BaseGrid& grid, std::vector<BaseRegion> regions,
                                                      const Monitor& monitor = {});

}  // namespace mmgrasp
