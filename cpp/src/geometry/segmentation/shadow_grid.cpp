#include "geometry/segmentation/shadow_grid.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/interruption.hpp"

namespace mmgrasp::detail {
namespace {

Eigen::AlignedBox2d box_of(const std::vector<Eigen::Vector3d>& triangle) {
  Eigen::AlignedBox2d box;
  for (const Eigen::Vector3d& p : triangle) box.extend(Eigen::Vector2d(p.head<2>()));
  return box;
}

}  // namespace

ShadowGrid::ShadowGrid(const std::vector<std::vector<Eigen::Vector3d>>& triangles) {
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const auto& t : triangles) {
    const Eigen::AlignedBox2d box = box_of(t);
    box_.extend(box);
    mean += box.sizes() / static_cast<double>(triangles.size());
  }
  // Cells as large as triangles are in the mean, so that a triangle lies in few of them; and no more of them than
  // triangles.
  const double most = std::max(1.0, std::floor(std::sqrt(static_cast<double>(triangles.size()))));
  int counts[2] = {1, 1};
  for (int axis = 0; axis < 2 && !triangles.empty(); ++axis) {
    const double extent = box_.sizes()[axis];
    if (!(extent > 0) || !(mean[axis] > 0)) continue;
    counts[axis] = static_cast<int>(std::clamp(std::floor(extent / mean[axis]), 1.0, most));
    size_[axis] = extent / counts[axis];
  }
  columns_ = counts[0];
  rows_ = counts[1];
  cells_.resize(static_cast<std::size_t>(columns_) * rows_);
  InterruptionPoll poll(256);
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    const Cells in = cells_of(triangles[i]);
    for (int y = in.y0; y <= in.y1; ++y) {
      poll();
      for (int x = in.x0; x <= in.x1; ++x)
        cells_[static_cast<std::size_t>(y) * columns_ + x].push_back(static_cast<int>(i));
    }
  }
}

std::vector<int> ShadowGrid::near(const std::vector<Eigen::Vector3d>& triangle) const {
  std::vector<int> out;
  if (!box_.intersects(box_of(triangle))) return out;
  const Cells in = cells_of(triangle);
  for (int y = in.y0; y <= in.y1; ++y)
    for (int x = in.x0; x <= in.x1; ++x) out.insert(out.end(), cell(x, y).begin(), cell(x, y).end());
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

ShadowGrid::Cells ShadowGrid::cells_of(const std::vector<Eigen::Vector3d>& triangle) const {
  const Eigen::AlignedBox2d box = box_of(triangle);
  const auto place = [&](const Eigen::Vector2d& p, int axis, int count) {
    return static_cast<int>(std::clamp(std::floor((p[axis] - box_.min()[axis]) / size_[axis]), 0.0, count - 1.0));
  };
  return {place(box.min(), 0, columns_), place(box.max(), 0, columns_), place(box.min(), 1, rows_),
          place(box.max(), 1, rows_)};
}

}  // namespace mmgrasp::detail
