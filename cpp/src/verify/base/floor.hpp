#pragma once

#include <vector>

#include "verify/context.hpp"

namespace mmgrasp::verify::detail {

constexpr double kSameHeading = 1e-3;  ///< Headings closer than this are one [rad].

/// The regions of a plan as flags over one grid, read through exact distances.
class Floor {
 public:
  Floor(const CheckedGrid& grid, std::vector<const CheckedRegion*> regions)
      : grid_(grid), regions_(std::move(regions)) {}

  const CheckedGrid& grid() const { return grid_; }
  int regions() const { return static_cast<int>(regions_.size()); }
  /// Layer nearest to this heading (modulo a full turn), closer than kSameHeading; -1: none.
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

}  // namespace mmgrasp::verify::detail
