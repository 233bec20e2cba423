#include "grasp/synthesis/hand_clearance.hpp"

#include <algorithm>
#include <cmath>

namespace mmgrasp::detail {
namespace {

using Eigen::Vector3d;

constexpr double kMostCells = 4e6;

}  // namespace

HandClearance::HandClearance(const std::vector<Vector3d>& points, const std::vector<double>& sigma, double sigmas,
                             double margin, const std::optional<double>& table)
    : margin_(margin), table_(table) {
  Eigen::AlignedBox3d bounds;
  for (const Vector3d& p : points) bounds.extend(p);
  if (bounds.isEmpty()) return;
  origin_ = bounds.min();
  const Vector3d size = bounds.diagonal();
  while ((size / side_).array().floor().matrix().prod() > kMostCells) side_ *= 1.5;
  for (int k = 0; k < 3; ++k) n_[k] = static_cast<int>(size[k] / side_) + 1;
  const auto cell_of = [&](const Vector3d& p) {
    std::size_t at[3];
    for (int k = 0; k < 3; ++k)
      at[k] = static_cast<std::size_t>(std::clamp(static_cast<int>((p[k] - origin_[k]) / side_), 0, n_[k] - 1));
    return (at[2] * n_[1] + at[1]) * n_[0] + at[0];
  };
  begin_.assign(static_cast<std::size_t>(n_[0]) * n_[1] * n_[2] + 1, 0);
  for (const Vector3d& p : points) ++begin_[cell_of(p) + 1];
  for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
  balls_.resize(points.size());
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double radius = margin + sigmas * sigma[i];
    largest_ = std::max(largest_, radius);
    balls_[next[cell_of(points[i])]++] = {points[i], radius};
  }
}

HandContact HandClearance::check(const std::vector<LinkShape>& boxes, const Pose& T_world_hand) const {
  for (const LinkShape& box : boxes) {
    const Pose T = T_world_hand * box.T_link_shape;
    const Vector3d half = std::get<Box>(box.shape).size / 2;
    const double lowest = T.translation().z() - T.linear().row(2).cwiseAbs().dot(half);
    if (table_ && lowest < *table_ + margin_) return HandContact::table;
    if (touches(T, half, {})) return HandContact::map;
  }
  return HandContact::none;
}

bool HandClearance::pierced(const std::vector<LinkShape>& boxes, const Pose& T_world_hand, double depth) const {
  return std::any_of(boxes.begin(), boxes.end(), [&](const LinkShape& box) {
    return touches(T_world_hand * box.T_link_shape, std::get<Box>(box.shape).size / 2, depth);
  });
}

bool HandClearance::touches(const Pose& T, const Vector3d& half, const std::optional<double>& depth) const {
  if (balls_.empty()) return false;
  const double most = depth ? 0 : largest_;
  const Vector3d reach = T.linear().cwiseAbs() * half + Vector3d::Constant(most);
  int low[3], high[3];
  for (int k = 0; k < 3; ++k) {
    const double from = (T.translation()[k] - reach[k] - origin_[k]) / side_,
                 to = (T.translation()[k] + reach[k] - origin_[k]) / side_;
    if (to < 0 || from >= n_[k]) return false;
    low[k] = std::max(0, static_cast<int>(std::floor(from)));
    high[k] = std::min(n_[k] - 1, static_cast<int>(to));
  }
  const Eigen::Matrix3d to_box = T.linear().transpose();
  const Vector3d offset = to_box * T.translation();
  // A cell is passed over when its middle is farther from the box than its half diagonal and the largest ball.
  const double far = side_ * std::sqrt(3.0) / 2 + most;
  for (int z = low[2]; z <= high[2]; ++z) {
    for (int y = low[1]; y <= high[1]; ++y) {
      const std::size_t row = (static_cast<std::size_t>(z) * n_[1] + y) * n_[0];
      for (int x = low[0]; x <= high[0]; ++x) {
        const std::uint32_t first = begin_[row + x], last = begin_[row + x + 1];
        if (first == last) continue;
        const Vector3d middle = origin_ + side_ * Vector3d(x + 0.5, y + 0.5, z + 0.5);
        const Vector3d outside = ((to_box * middle - offset).cwiseAbs() - half).cwiseMax(0);
        if (outside.squaredNorm() > far * far) continue;
        for (std::uint32_t i = first; i < last; ++i) {
          const Vector3d beyond = (to_box * balls_[i].centre - offset).cwiseAbs() - half;
          const double radius = balls_[i].radius;
          if (depth ? beyond.maxCoeff() < -*depth : beyond.cwiseMax(0).squaredNorm() < radius * radius) return true;
        }
      }
    }
  }
  return false;
}

}  // namespace mmgrasp::detail
