#include "grasp/synthesis/point_grid.hpp"

namespace mmgrasp::detail {
namespace {

constexpr double kMostCells = 4e6;

}  // namespace

PointGrid::PointGrid(const std::vector<Eigen::Vector3d>& points, double side) : side_(side) {
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& p : points) bounds.extend(p);
  if (bounds.isEmpty()) return;
  origin_ = bounds.min();
  const Eigen::Vector3d size = bounds.diagonal();
  while (((size / side_).array().floor() + 1).matrix().prod() > kMostCells) side_ *= 1.5;
  for (int k = 0; k < 3; ++k) n_[k] = static_cast<int>(size[k] / side_) + 1;
  const auto cell_of = [&](const Eigen::Vector3d& p) {
    std::size_t at[3];
    for (int k = 0; k < 3; ++k) at[k] = std::clamp(static_cast<int>((p[k] - origin_[k]) / side_), 0, n_[k] - 1);
    return (at[2] * n_[1] + at[1]) * n_[0] + at[0];
  };
  begin_.assign(static_cast<std::size_t>(n_[0]) * n_[1] * n_[2] + 1, 0);
  for (const Eigen::Vector3d& p : points) ++begin_[cell_of(p) + 1];
  for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
  order_.resize(points.size());
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  for (std::size_t i = 0; i < points.size(); ++i) order_[next[cell_of(points[i])]++] = static_cast<std::uint32_t>(i);
}

}  // namespace mmgrasp::detail
