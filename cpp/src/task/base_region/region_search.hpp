#pragma once

#include <cstdint>
#include <vector>

#include "mmgrasp/task/base_pose_evaluator.hpp"
#include "mmgrasp/task/base_region.hpp"
#include "task/base_region/home_map.hpp"
#include "task/base_region/tray_window.hpp"

namespace mmgrasp::detail {

/// The work behind compute_base_regions() and ObjectRegions: tries base poses in windows around the trays, so that
/// memory and time grow with the trays and not with their square. Can be copied: a copy goes on from there.
class RegionSearch {
 public:
  /// `evaluator`: of the problem with all parts in place; it is cloned. `resumable`: remembers what resume_without()
  /// needs. The problem must outlive the search.
  RegionSearch(const PartSupplyProblem& problem, const ReachDatabase& database, const BaseGrid& grid,
               const BasePoseEvaluator& evaluator, bool resumable);
  /// Trays that list no headings, at those that are not theirs, in the cells flagged in `served` alone.
  RegionSearch(const PartSupplyProblem& problem, const ReachDatabase& database, const BaseGrid& grid,
               const BasePoseEvaluator& evaluator, const CellMask& served);
  RegionSearch(const RegionSearch& other);
  RegionSearch& operator=(const RegionSearch&) = delete;

  int trays() const { return static_cast<int>(problem_->trays.size()); }
  /// Tries what has not been tried yet for the trays in [first, last). False when stopped.
  bool run(int first, int last, const Monitor& monitor);
  /// The region of the parts that are in place, after run(). A tray without target parts: empty.
  BaseRegion region(TrayId tray) const;
  /// Frees what the tray's work takes; its region is then empty.
  void forget(TrayId tray);
  /// Indices of the target parts that are in place, ascending.
  std::vector<int> parts(TrayId tray) const;
  bool present(PartRef part) const;
  /// Flags in `cells`, all zero before, those from which every one of these target parts can be grasped.
  void common_cells(TrayId tray, const std::vector<int>& parts, CellMask& cells) const;
  /// Removes these parts: what they may have blocked counts as not tried. To be followed by run().
  void resume_without(const std::vector<PartRef>& removed);

 private:
  /// What one row of base poses adds to a part's explanation.
  struct RowCount {
    std::size_t tried = 0, feasible = 0;
    Rejections rejections;
  };
  struct RowResult {
    std::vector<RowCount> counts;
    std::vector<BlockedPose> blocked;
  };

  RegionSearch(const PartSupplyProblem& problem, const BaseGrid& grid, const BasePoseEvaluator& evaluator,
               bool resumable);
  void add_windows(TrayId tray, const ReachDatabase& database, const CellMask* served);
  void clone_evaluators(const BasePoseEvaluator& evaluator);
  std::uint8_t& home(const TrayWindow& window, bool corner, int ix, int iy);
  bool check_home(const std::vector<TrayWindow*>& windows, bool corner, const Monitor& monitor);
  bool check_parts(const std::vector<TrayWindow*>& windows, bool corner, const Monitor& monitor);
  void check_row(TrayWindow& window, int iy, bool corner, RowResult& result, BasePoseEvaluator& evaluator,
                 const Monitor& monitor);

  const PartSupplyProblem* problem_;
  BaseGrid grid_;
  bool resumable_;
  int threads_;
  std::vector<std::vector<std::uint8_t>> removed_;  // [tray][part]
  std::vector<BasePoseEvaluator> evaluators_;       // one a thread
  std::vector<TrayWindow> windows_;
  HomeMap home_;
};

/// compute_base_regions() with an evaluator that exists already.
std::vector<BaseRegion> compute_base_regions(const PartSupplyProblem& problem, const ReachDatabase& database,
                                             const BaseGrid& grid, const BasePoseEvaluator& evaluator,
                                             const Monitor& monitor);

/// share_headings() with an evaluator that exists already.
std::vector<BaseRegion> share_headings(const PartSupplyProblem& problem, const ReachDatabase& database,
                                       const BaseGrid& grid, std::vector<BaseRegion> regions,
                                       const BasePoseEvaluator& evaluator, const Monitor& monitor);

}  // namespace mmgrasp::detail
