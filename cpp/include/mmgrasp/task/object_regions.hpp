#pragma once

#include <memory>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/task/base_region.hpp"
#include "mmgrasp/task/ids.hpp"

namespace mmgrasp {

/// The region of every target part alone, kept, so that the region of any selection of parts of a tray (all, those that
/// remain, those to be picked; P1 3.4.1, 3.5.1) is an intersection of ready bitmaps.
///
/// Parts that are in place are obstacles, targets or not. When a part is removed, the base poses that it blocked are
/// tried again: the bitmaps are always those of a computation from scratch without it, and regions never shrink.
/// @code
///   ObjectRegions regions = ObjectRegions::compute(problem, database, make_base_grid(problem, database));
///   const CellMask both = regions.region(TrayId(0), {1, 3});  // parts 1 and 3 of the first tray
///   regions.remove({{TrayId(0), 1}});                         // part 1 was picked
/// @endcode
class MMGRASP_EXPORT ObjectRegions {
 public:
  /// The same as compute_base_regions(): cell by cell, centre and corners. Same answer at any thread count.
  static ObjectRegions compute(const PartSupplyProblem& problem, const ReachDatabase& database, const BaseGrid& grid,
                               const Monitor& monitor = {});
  ObjectRegions(ObjectRegions&&) noexcept;
  ObjectRegions& operator=(ObjectRegions&&) noexcept;
  ~ObjectRegions();

  /// False when compute() was stopped: every query but this one throws InvalidInput then.
  bool complete() const;
  const BaseGrid& grid() const;
  int trays() const;
  /// Target parts of a tray that are in place, ascending (indices into Tray::parts). Throws InvalidInput on a wrong
  /// tray.
  std::vector<int> parts(TrayId tray) const;
  /// Cells from which every one of these parts can be grasped. Throws InvalidInput on a wrong tray, an empty list and
  /// on parts that are no targets or not in place.
  CellMask region(TrayId tray, const std::vector<int>& parts) const;
  /// The region of all target parts in place, with what became of the candidates; empty without any.
  BaseRegion base_region(TrayId tray) const;
  /// Removes parts, targets or not. Throws InvalidInput on one that is not in place. False when the monitor ended it;
  /// nothing has changed then.
  bool remove(const std::vector<PartRef>& removed, const Monitor& monitor = {});

 private:
  struct Impl;
  explicit ObjectRegions(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace mmgrasp
