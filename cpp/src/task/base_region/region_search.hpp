#pragma once

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "mmgrasp/task/base_region.hpp"

namespace mmgrasp {

/// The work behind compute_base_regions() and ObjectRegions: which base poses were tried for which part and what became
/// of them, in windows around the trays, so that memory and time grow with the trays and not with their square. Can be
/// copied: a copy goes on from there.
class RegionSearch {
 public:
  /// `keep_open`: remembers what resume_without() needs. The problem must outlive the search.
  RegionSearch(const PartSupplyProblem& problem, const ReachDatabase& database, const BaseGrid& grid, bool keep_open);
  RegionSearch(const RegionSearch& other);
  RegionSearch& operator=(const RegionSearch&) = delete;

  int trays() const { return static_cast<int>(problem_->trays.size()); }
  /// Tries what has not been tried yet for the trays in [first, last). False when stopped.
  bool run(int first, int last, const Monitor& monitor);
  /// After run(): of the parts that have not left. A tray without target parts: empty.
  BaseRegion region(int tray) const;
  /// Frees what the tray's work takes; its region is then empty.
  void forget(int tray);
  /// Target parts that have not left, ascending.
  std::vector<int> parts(int tray) const;
  bool present(int tray, int part) const;
  /// Flags in `cells`, all zero before, those from which every one of these target parts can be grasped.
  void common_cells(int tray, const std::vector<int>& parts, CellMask& cells) const;
  /// These parts leave: what they may have blocked counts as not tried. To be followed by run().
  void resume_without(const std::vector<std::pair<int, int>>& tray_and_part);

 private:
  /// A base pose from which a part cannot be grasped because of the scene.
  struct Blocked {
    int slot, ix, iy;
    bool corner;
    std::array<std::uint32_t, 5> causes;
  };
  /// One tray and one of its headings.
  struct Task {
    int tray = 0, heading = 0;
    int x0 = 0, y0 = 0, nx = 0, ny = 0;  // window of cells
    std::vector<int> parts;              // its target parts
    std::vector<std::uint8_t> in_range;  // cells whose centre is within the search radius
    // One a part, (nx + 1) x (ny + 1) base poses each: Mark bits. Apart, because rows of corners read rows of centres.
    std::vector<std::vector<std::uint8_t>> centres, corners;
    std::vector<std::uint8_t> good_anywhere;  // centres that are good for some part
    std::vector<PartExplanation> totals;      // one a part
    std::vector<Blocked> blocked;
    std::size_t at(int ix, int iy) const {
      return static_cast<std::size_t>(iy) * static_cast<std::size_t>(nx + 1) + static_cast<std::size_t>(ix);
    }
    bool cell(std::size_t slot, int ix, int iy) const;
    /// Is one of the cells around a corner marked good?
    bool beside(const std::vector<std::uint8_t>& good, int ix, int iy) const;
  };
  /// What one row of base poses adds to a part's explanation.
  struct RowCount {
    std::size_t tried = 0, feasible = 0;
    Rejections rejections;
  };
  struct RowResult {
    std::vector<RowCount> counts;
    std::vector<Blocked> blocked;
  };
  struct Home {
    std::vector<std::uint8_t> centres, corners;  // of one layer: HomeState
  };

  void add_tasks(int tray, const ReachDatabase& database);
  Eigen::Vector3d pose(const Task& task, bool corner, int ix, int iy) const;
  std::uint8_t& home(const Task& task, bool corner, int ix, int iy);
  bool wanted(const Task& task, std::size_t slot, bool corner, int ix, int iy) const;
  bool check_home(const std::vector<Task*>& tasks, bool corner, const Monitor& monitor);
  bool check_parts(const std::vector<Task*>& tasks, bool corner, const Monitor& monitor);
  void check_row(Task& task, int iy, bool corner, RowResult& result, BasePoseEvaluator& evaluator,
                 const Monitor& monitor);

  const PartSupplyProblem* problem_;
  BaseGrid grid_;
  bool keep_open_;
  int threads_;
  std::vector<std::vector<std::uint8_t>> gone_;  // [tray][part]
  std::vector<BasePoseEvaluator> evaluators_;    // one a thread
  std::vector<Task> tasks_;
  std::vector<Home> home_;
};

}  // namespace mmgrasp
