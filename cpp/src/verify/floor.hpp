#pragma once

#include <set>
#include <vector>

#include "verify/context.hpp"

namespace mmgrasp::verify::detail {

/// Indices of regions (trays).
using RegionSet = std::set<int>;

/// The regions of a plan as flags over one grid, read through exact distances.
class Floor {
 public:
  Floor(const CheckedGrid& grid, std::vector<const CheckedRegion*> regions)
      : grid_(grid), regions_(std::move(regions)) {}

  const CheckedGrid& grid() const { return grid_; }
  int regions() const { return static_cast<int>(regions_.size()); }
  /// Layer with this heading (modulo a full turn, to 1e-6 rad); -1: none.
  int layer(double heading) const;
  /// Distance from a point in the region to the nearest place that is not in it; for a point outside, minus the
  /// distance to the region. Not checked beyond `cap`.
  double clearance(int region, int layer, const Eigen::Vector2d& point, double cap) const;
  /// Whether a cell is in a region; false outside the grid.
  bool inside(int region, int layer, int ix, int iy) const;
  /// Whether any cell of a layer is in a region.
  bool any(int region, int layer) const;

 private:
  const CheckedGrid& grid_;
  std::vector<const CheckedRegion*> regions_;
};

/// Every maximal set of regions whose shared floor holds a disc of this radius (> 0) somewhere. Exact for discs of at
/// most a cell's size. Larger ones are found by halving squares until nothing new can hide in one, down to 1/256 of a
/// cell, or less far where regions are so ragged that this would take seconds: sets whose discs fit only in places
/// smaller than that are not found.
std::vector<RegionSet> common_discs(const Floor& floor, double radius, const Monitor& monitor);

/// Adds a set unless one in the list holds it; drops those that it holds.
void add_maximal(std::vector<RegionSet>& sets, const RegionSet& set);

/// Least number of sets that cover all of `wanted`, by CBC; -1 when they cannot.
int smallest_cover(const std::vector<RegionSet>& sets, const RegionSet& wanted);

}  // namespace mmgrasp::verify::detail
