#include "mmgrasp/geometry/grid_distance_field.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"

namespace mmgrasp {

void GridDistanceField::Grid::check() const {
  std::size_t points = 1;
  for (const int count : size) {
    require(count >= 2, "size", count, "must be at least 2 along each axis");
    points *= count;
  }
  require(values.size() == points, "values", static_cast<double>(values.size()),
          "must be as many as the grid has points (" + std::to_string(points) + ")");
  for (const double value : values)
    require(!(std::abs(value) > kLargestLength), "values", value,
            "must be finite and within 1e6 m, or NaN where unknown");
  require_position(origin, "origin");
  require_length(spacing, "spacing");
  for (const int count : size)
    require(count * spacing <= kLargestLength, "spacing", spacing, "must keep the grid below 1e6 m");
  require_within(error, 0, kLargestLength, "error", "m");
  require(truncation > 0, "truncation", truncation, "must be > 0 [m]");
}

GridDistanceField::GridDistanceField(Grid grid) : grid_(std::move(grid)) {
  grid_.check();
}

DistanceFieldProperties GridDistanceField::properties() const {
  DistanceFieldProperties out;
  const Eigen::Vector3d cells(grid_.size[0] - 1, grid_.size[1] - 1, grid_.size[2] - 1);
  out.domain = {grid_.origin, Eigen::Vector3d(grid_.origin + grid_.spacing * cells)};
  out.error = grid_.error + 0.5 * std::sqrt(3.0) * grid_.spacing;
  out.truncation = grid_.truncation;
  return out;
}

void GridDistanceField::evaluate(const Eigen::Matrix3Xd& points, Eigen::VectorXd& distances,
                                 Eigen::Matrix3Xd* gradients) const {
  const Eigen::AlignedBox3d domain = properties().domain;
  const std::size_t along_y = grid_.size[2], along_x = along_y * grid_.size[1];
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    distances[i] = std::numeric_limits<double>::quiet_NaN();
    if (gradients) gradients->col(i).setZero();
    if (!domain.contains(Eigen::Vector3d(points.col(i)))) continue;
    const Eigen::Vector3d at = (points.col(i) - grid_.origin) / grid_.spacing;
    int cell[3];
    double share[3];
    for (int k = 0; k < 3; ++k) {
      cell[k] = std::clamp(static_cast<int>(at[k]), 0, grid_.size[k] - 2);
      share[k] = std::clamp(at[k] - cell[k], 0.0, 1.0);
    }
    const double* corner = &grid_.values[cell[0] * along_x + cell[1] * along_y + cell[2]];
    double value = 0;
    Eigen::Vector3d slope = Eigen::Vector3d::Zero();
    for (int c = 0; c < 8; ++c) {
      double weight[3], change[3];
      for (int k = 0; k < 3; ++k) {
        weight[k] = c >> k & 1 ? share[k] : 1 - share[k];
        change[k] = c >> k & 1 ? 1 : -1;
      }
      const double known = corner[(c & 1) * along_x + (c >> 1 & 1) * along_y + (c >> 2 & 1)];
      const double all = weight[0] * weight[1] * weight[2];
      if (all > 0) value += all * known;
      if (!std::isnan(known))
        slope += known * Eigen::Vector3d(change[0] * weight[1] * weight[2], weight[0] * change[1] * weight[2],
                                         weight[0] * weight[1] * change[2]);
    }
    distances[i] = std::clamp(value, -grid_.truncation, grid_.truncation);
    if (std::isnan(value)) distances[i] = value;
    if (gradients && !std::isnan(value) && slope.norm() > 0) gradients->col(i) = slope.normalized();
  }
}

}  // namespace mmgrasp
