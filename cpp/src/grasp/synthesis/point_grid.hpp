#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "mmgrasp/core/export.hpp"

namespace mmgrasp::detail {

/// Points by the cells of a cubic lattice over their bounds.
class MMGRASP_EXPORT PointGrid {
 public:
  /// `side` of a cell [m]; larger when there would be more than four million.
  PointGrid(const std::vector<Eigen::Vector3d>& points, double side);

  double side() const { return side_; }
  /// Indices of the points, cell by cell.
  const std::vector<std::uint32_t>& order() const { return order_; }

  /// Calls visit(middle, first, last) for every cell with points that the box touches, a range of order(), until it
  /// returns true; returns whether it did.
  template <typename Visit>
  bool any_cell(const Eigen::AlignedBox3d& box, const Visit& visit) const {
    if (order_.empty()) return false;
    int low[3], high[3];
    for (int k = 0; k < 3; ++k) {
      const double from = (box.min()[k] - origin_[k]) / side_, to = (box.max()[k] - origin_[k]) / side_;
      if (!(to >= 0) || !(from < n_[k])) return false;
      low[k] = static_cast<int>(std::max(0.0, from));
      high[k] = static_cast<int>(std::min(n_[k] - 1.0, to));
    }
    for (int z = low[2]; z <= high[2]; ++z) {
      for (int y = low[1]; y <= high[1]; ++y) {
        const std::size_t row = (static_cast<std::size_t>(z) * n_[1] + y) * n_[0];
        for (int x = low[0]; x <= high[0]; ++x) {
          const std::uint32_t first = begin_[row + x], last = begin_[row + x + 1];
          if (first == last) continue;
          const Eigen::Vector3d middle = origin_ + side_ * Eigen::Vector3d(x + 0.5, y + 0.5, z + 0.5);
          if (visit(middle, first, last)) return true;
        }
      }
    }
    return false;
  }

 private:
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  double side_;
  int n_[3] = {0, 0, 0};
  std::vector<std::uint32_t> begin_;  ///< First of each cell in order_, and one past the last.
  std::vector<std::uint32_t> order_;
};

}  // namespace mmgrasp::detail
