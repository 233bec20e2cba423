#pragma once

#include <Eigen/Geometry>
#include <vector>

namespace mmgrasp::detail {

/// Triangles by the cells of a plane (x and y) that their boxes lie in: what may meet another one is found without
/// looking at all.
class ShadowGrid {
 public:
  explicit ShadowGrid(const std::vector<std::vector<Eigen::Vector3d>>& triangles);

  /// Numbers, ascending, of the triangles whose boxes share a cell with that of `triangle`.
  std::vector<int> near(const std::vector<Eigen::Vector3d>& triangle) const;

 private:
  struct Cells {
    int x0, x1, y0, y1;
  };
  Cells cells_of(const std::vector<Eigen::Vector3d>& triangle) const;
  const std::vector<int>& cell(int x, int y) const { return cells_[static_cast<std::size_t>(y) * columns_ + x]; }

  Eigen::AlignedBox2d box_;
  Eigen::Vector2d size_ = Eigen::Vector2d::Ones();  // A cell's [m].
  int columns_ = 1, rows_ = 1;
  std::vector<std::vector<int>> cells_;
};

}  // namespace mmgrasp::detail
