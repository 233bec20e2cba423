#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "mmgrasp/task/base_region.hpp"
#include "mmgrasp/task/ids.hpp"

namespace mmgrasp::detail {

/// A base pose from which a part cannot be grasped because of the scene.
struct BlockedPose {
  int slot, ix, iy;
  bool corner;
  std::array<std::uint32_t, 5>
      causes;  ///< Grasps rejected as unreachable, for limits, self-collision, scene, grasp filter.
};

/// The base poses around one tray with one of its headings: a window of the grid's cells, for each target part marks
/// on centres and corners of the cells (tried, good), and what became of the candidates. Cells are counted from the
/// window's own corner; a slot is an index into parts().
class TrayWindow {
 public:
  /// Cells whose centre is within `radius` of the tray's `middle` are in range.
  TrayWindow(TrayId tray, int heading, std::vector<int> parts, const BaseGrid& grid, const Eigen::Vector2d& middle,
             double radius);

  /// Takes cells out of range that are not flagged in the grid's `cells`. False when none is left.
  bool keep_only(const BaseGrid& grid, const CellMask& cells);

  TrayId tray() const { return tray_; }
  int heading() const { return heading_; }
  int nx() const { return nx_; }
  int ny() const { return ny_; }
  int grid_x(int ix) const { return x0_ + ix; }
  int grid_y(int iy) const { return y0_ + iy; }
  const std::vector<int>& parts() const { return parts_; }  ///< Target parts, ascending.
  bool in_range(int ix, int iy) const { return in_range_[cell(ix, iy)] != 0; }
  /// Base pose of a cell's centre or of its lower corner.
  Eigen::Vector3d pose(const BaseGrid& grid, bool corner, int ix, int iy) const;

  /// Makes room for marks; forget() frees it.
  void begin();
  void forget();
  bool begun() const { return !good_anywhere_.empty(); }

  /// Whether a base pose is to be tried for a part: centres in range, and corners of cells whose centre is good for it.
  bool wanted(std::size_t slot, bool corner, int ix, int iy) const;
  /// Whether it is to be tried for any part, as far as the centres tell.
  bool wanted_for_any(bool corner, int ix, int iy) const;
  bool tried(std::size_t slot, bool corner, int ix, int iy) const;
  void mark_tried(std::size_t slot, bool corner, int ix, int iy);
  void mark_good(std::size_t slot, bool corner, int ix, int iy);
  /// The part can be grasped at the cell's centre and at all of its corners.
  bool in_region(std::size_t slot, int ix, int iy) const;
  std::vector<std::uint8_t> region_flags(std::size_t slot) const;  ///< in_region() of nx x ny cells, row by row.

  const PartExplanation& total(std::size_t slot) const { return totals_[slot]; }
  void add(std::size_t slot, std::size_t tried, std::size_t feasible, const Rejections& rejections);
  void add_blocked(const std::vector<BlockedPose>& poses);
  /// The blocked poses count as not tried again, and the parts marked in `removed` (by their index) are given up.
  void resume_without(const std::vector<std::uint8_t>& removed);

 private:
  std::size_t cell(int ix, int iy) const { return static_cast<std::size_t>(iy) * nx_ + ix; }
  std::size_t at(int ix, int iy) const { return static_cast<std::size_t>(iy) * (nx_ + 1) + ix; }
  /// Is one of the cells around a corner marked good?
  bool beside(const std::vector<std::uint8_t>& good, int ix, int iy) const;

  TrayId tray_;
  int heading_ = 0;
  int x0_ = 0, y0_ = 0, nx_ = 0, ny_ = 0;
  std::vector<int> parts_;
  std::vector<std::uint8_t> in_range_;
  // Marks of one part each on (nx + 1) x (ny + 1) base poses. Apart, because rows of corners read rows of centres.
  std::vector<std::vector<std::uint8_t>> centres_, corners_;
  std::vector<std::uint8_t> good_anywhere_;  // centres that are good for some part
  std::vector<PartExplanation> totals_;      // one a part
  std::vector<BlockedPose> blocked_;
};

}  // namespace mmgrasp::detail
