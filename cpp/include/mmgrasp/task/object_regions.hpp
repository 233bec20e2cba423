#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/task/base_region.hpp"

namespace mmgrasp {

/// The region of every target part alone, kept, so that the region of any choice of parts of a tray (all, those that
/// remain, those to be picked; P1 3.4.1, 3.5.1) is an intersection of ready bitmaps. Parts that are in place are
/// obstacles, targets or not; a part that leaves is none any more, and what it stood in the way of is looked at again:
/// the bitmaps are always those of a computation from scratch without it. Regions never shrink by that.
class MMGRASP_EXPORT ObjectRegions {
 public:
  /// The same as compute_base_regions(): cell by cell, centre and corners. Same answer at any thread count.
  static ObjectRegions compute(const PartSupplyProblem& problem, const ReachDatabase& database, const BaseGrid& grid,
                               const Monitor& monitor = {});
  ObjectRegions(ObjectRegions&&) noexcept;
  ObjectRegions& operator=(ObjectRegions&&) noexcept;
  ~ObjectRegions();

  /// False when compute() was stopped: nothing else may be asked then.
  bool complete() const;
  const BaseGrid& grid() const;
  int trays() const;
  /// Target parts of a tray that are in place, ascending (indices into Tray::parts). Throws InvalidInput on a wrong
  /// tray.
  std::vector<int> parts(int tray) const;
  /// Cells from which every one of these parts can be grasped. Throws InvalidInput on a wrong tray, an empty list and
  /// on parts that are no targets or not in place.
  CellMask region(int tray, const std::vector<int>& parts) const;
  /// The region of all target parts in place, with what became of the candidates; empty without any.
  BaseRegion base_region(int tray) const;
  /// Parts (tray, part) leave, targets or not. Throws InvalidInput on one that is not in place. Stopped, it returns
  /// false and nothing has changed.
  bool remove(const std::vector<std::pair<int, int>>& tray_and_part, const Monitor& monitor = {});

 private:
  struct Impl;
  explicit ObjectRegions(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace mmgrasp
