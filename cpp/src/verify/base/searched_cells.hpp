#pragma once

#include <map>
#include <string>
#include <vector>

#include "mmgrasp/core/detail/interruption.hpp"
#include "verify/base/grasp_search.hpp"
#include "verify/context.hpp"

namespace mmgrasp::verify::detail {

struct Cell {
  int layer, ix, iy;
};

/// The cells of one region, and those that were searched for its tray and are not in it.
class SearchedCells {
 public:
  SearchedCells(const PlanToCheck& plan, const CheckedRegion& region)
      : plan_(plan), grid_(plan.grid), region_(region), searched_(plan.searched.find(region.tray)) {}

  std::size_t index(const Cell& cell) const {
    return (static_cast<std::size_t>(cell.layer) * grid_.ny + cell.iy) * grid_.nx + cell.ix;
  }
  bool on_grid(const Cell& cell) const {
    return cell.ix >= 0 && cell.iy >= 0 && cell.ix < grid_.nx && cell.iy < grid_.ny;
  }
  bool has(const Cell& cell) const { return on_grid(cell) && region_.cells[index(cell)] != 0; }
  /// Whether it was searched for the tray and is not in the region.
  bool is_left_out(const Cell& cell) const;
  /// A place in a cell, from (0, 0), its lower corner, to (1, 1).
  Eigen::Vector3d pose(const Cell& cell, double x, double y) const {
    return {grid_.origin.x() + (cell.ix + x) * grid_.resolution, grid_.origin.y() + (cell.iy + y) * grid_.resolution,
            grid_.headings[cell.layer]};
  }

  template <typename Visitor>
  void visit(const Visitor& visitor) const {
    for (int layer = 0; layer < static_cast<int>(grid_.headings.size()); ++layer) {
      for (int iy = 0; iy < grid_.ny; ++iy) {
        mmgrasp::detail::throw_if_interrupted();
        for (int ix = 0; ix < grid_.nx; ++ix) visitor(Cell{layer, ix, iy});
      }
    }
  }

 private:
  bool other_is_served(const Cell& cell) const;

  const PlanToCheck& plan_;
  const CheckedGrid& grid_;
  const CheckedRegion& region_;
  std::map<std::string, CheckedTray>::const_iterator searched_;
};

/// Whether the robot may stand there, at home and in its workspace, and grasp all these parts.
bool base_pose_serves(const PlanToCheck& plan, GraspSearch& search, const Eigen::Vector3d& pose,
                      const std::vector<int>& parts, Effort effort = Effort::usual);

/// Whether a cell serves the parts at its corners and its middle, which is how planners look at a cell. Corners are
/// taken a little farther out, and grasps at which the robot just touches something do not count: either answer is
/// right there.
bool whole_cell_serves(const PlanToCheck& plan, GraspSearch& search, const SearchedCells& cells, const Cell& cell,
                       const std::vector<int>& parts);

}  // namespace mmgrasp::verify::detail
