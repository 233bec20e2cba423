#include "reach/rotation_cells.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace mmgrasp::detail {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Turns v by the smallest rotation that takes unit `from` to unit `to`; undefined for opposite vectors.
Eigen::Vector3d carry(const Eigen::Vector3d& v, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d w = from.cross(to), wv = w.cross(v);
  return v + wv + w.cross(wv) / (1 + from.dot(to));
}

/// Faces in the order +x, -x, +y, -y, +z, -z.
Eigen::Vector3d face_normal(std::uint32_t face) {
  return (face % 2 == 0 ? 1.0 : -1.0) * Eigen::Vector3d::Unit(face / 2);
}

double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

}  // namespace

RotationCells::RotationCells(double cell) {
  side_ = static_cast<std::uint32_t>(std::max(1.0, std::ceil(kPi / 2 / cell)));
  rolls_ = static_cast<std::uint32_t>(std::max(3.0, std::ceil(2 * kPi / cell)));
  for (std::uint32_t face = 0; face < 6; ++face)
    for (std::uint32_t i = 0; i < side_; ++i)
      for (std::uint32_t j = 0; j < side_; ++j) add_cell(face, i, j);
  neighbours_first_.push_back(0);
  for (std::uint32_t direction = 0; direction < directions(); ++direction) add_neighbours(direction);
}

Eigen::Vector3d RotationCells::direction_at(std::uint32_t face, double i, double j) const {
  const std::uint32_t axis = face / 2;
  Eigen::Vector3d direction = face_normal(face);
  direction[(axis + 1) % 3] = std::tan(kPi / 2 * (i / side_ - 0.5));
  direction[(axis + 2) % 3] = std::tan(kPi / 2 * (j / side_ - 0.5));
  return direction.normalized();
}

void RotationCells::add_cell(std::uint32_t face, std::uint32_t i, std::uint32_t j) {
  const Eigen::Vector3d centre = direction_at(face, i + 0.5, j + 0.5);
  double radius = 0;
  for (const std::uint32_t di : {0u, 1u})
    for (const std::uint32_t dj : {0u, 1u}) radius = std::max(radius, angle_between(centre, direction_at(face, i + di, j + dj)));
  centres_.push_back(centre);
  radii_.push_back(radius);
  roll_zero_.push_back(carry(Eigen::Vector3d::Unit((face / 2 + 1) % 3), face_normal(face), centre));
}

void RotationCells::add_neighbours(std::uint32_t cell) {
  const std::uint32_t face = cell / (side_ * side_), i = cell / side_ % side_, j = cell % side_;
  std::vector<std::uint32_t> found;
  // Every cell that touches this one has a corner in common with it: look around the corners, over the cube's edges too.
  for (const std::uint32_t di : {0u, 1u}) {
    for (const std::uint32_t dj : {0u, 1u}) {
      const Eigen::Vector3d corner = direction_at(face, i + di, j + dj);
      const Eigen::Vector3d u = corner.unitOrthogonal(), v = corner.cross(u);
      for (int k = 0; k < 16; ++k) {
        const double angle = 2 * kPi * (k + 0.5) / 16;
        found.push_back(direction_id(corner + 1e-6 * (std::cos(angle) * u + std::sin(angle) * v)));
      }
    }
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  found.erase(std::remove(found.begin(), found.end(), cell), found.end());
  neighbours_.push_back(cell);
  neighbours_.insert(neighbours_.end(), found.begin(), found.end());
  neighbours_first_.push_back(static_cast<std::uint32_t>(neighbours_.size()));
}

std::uint32_t RotationCells::direction_id(const Eigen::Vector3d& direction) const {
  Eigen::Index axis;
  const double longest = direction.cwiseAbs().maxCoeff(&axis);
  const std::uint32_t face = 2 * static_cast<std::uint32_t>(axis) + (direction[axis] < 0 ? 1 : 0);
  const auto index = [&](double component) {
    const double at = (std::atan2(component, longest) / (kPi / 2) + 0.5) * side_;
    return static_cast<std::uint32_t>(std::clamp(std::floor(at), 0.0, side_ - 1.0));
  };
  return (face * side_ + index(direction[(axis + 1) % 3])) * side_ + index(direction[(axis + 2) % 3]);
}

std::uint32_t RotationCells::roll_id(const Eigen::Matrix3d& R, std::uint32_t direction) const {
  const Eigen::Vector3d &centre = centres_[direction], &zero = roll_zero_[direction];
  const Eigen::Vector3d x = carry(R.col(0), R.col(2), centre);
  const double roll = std::atan2(x.dot(centre.cross(zero)), x.dot(zero));
  const double at = (roll / (2 * kPi) + 0.5) * rolls_;
  return std::min(static_cast<std::uint32_t>(std::max(at, 0.0)), rolls_ - 1);
}

std::uint32_t RotationCells::id(const Eigen::Matrix3d& R) const {
  const std::uint32_t direction = direction_id(R.col(2));
  return direction * rolls_ + roll_id(R, direction);
}

double RotationCells::angle_to(const Eigen::Vector3d& direction, std::uint32_t cell) const {
  return std::max(0.0, angle_between(direction, centres_[cell]) - radii_[cell]);
}

}  // namespace mmgrasp::detail
