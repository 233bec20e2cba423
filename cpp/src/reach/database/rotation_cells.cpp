#include "reach/database/rotation_cells.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {
namespace {

/// Turns v by the smallest rotation that takes unit `from` to unit `to`; undefined for opposite vectors.
Eigen::Vector3d transport(const Eigen::Vector3d& v, const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d w = from.cross(to), wv = w.cross(v);
  return v + wv + w.cross(wv) / (1 + from.dot(to));
}

/// Faces in the order +x, -x, +y, -y, +z, -z.
Eigen::Vector3d face_normal(std::uint32_t face) {
  return (face % 2 == 0 ? 1.0 : -1.0) * Eigen::Vector3d::Unit(face / 2);
}

double angle_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace

RotationCells::RotationCells(double cell) {
  side_ = static_cast<std::uint32_t>(std::max(1.0, std::ceil(kPi / 2 / cell)));
  rolls_ = static_cast<std::uint32_t>(std::max(3.0, std::ceil(kTwoPi / cell)));
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
  const std::array<Eigen::Vector3d, 4> corners{direction_at(face, i, j), direction_at(face, i + 1, j),
                                               direction_at(face, i + 1, j + 1), direction_at(face, i, j + 1)};
  std::array<Eigen::Vector3d, 4> sides;
  for (std::size_t k = 0; k < 4; ++k) {
    radius = std::max(radius, angle_between(centre, corners[k]));
    const Eigen::Vector3d normal = corners[k].cross(corners[(k + 1) % 4]).normalized();
    sides[k] = normal.dot(centre) > 0 ? normal : Eigen::Vector3d(-normal);
  }
  sides_.push_back(sides);
  centres_.push_back(centre);
  half_radius_tangents_.push_back(std::tan(radius / 2));
  roll_zero_.push_back(transport(Eigen::Vector3d::Unit((face / 2 + 1) % 3), face_normal(face), centre));
}

void RotationCells::add_neighbours(std::uint32_t cell) {
  const std::uint32_t face = cell / (side_ * side_), i = cell / side_ % side_, j = cell % side_;
  std::vector<std::uint32_t> found;
  // Every cell that touches this one has a corner in common with it: look around the corners, over the cube's edges
  // too.
  for (const std::uint32_t di : {0u, 1u}) {
    for (const std::uint32_t dj : {0u, 1u}) {
      const Eigen::Vector3d corner = direction_at(face, i + di, j + dj);
      const Eigen::Vector3d u = corner.unitOrthogonal(), v = corner.cross(u);
      for (int k = 0; k < 16; ++k) {
        const double angle = kTwoPi * (k + 0.5) / 16;
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

double RotationCells::roll_at(const Eigen::Matrix3d& R, std::uint32_t direction) const {
  const Eigen::Vector3d &centre = centres_[direction], &zero = roll_zero_[direction];
  const Eigen::Vector3d x = transport(R.col(0), R.col(2), centre);
  const double roll = std::atan2(x.dot(centre.cross(zero)), x.dot(zero));
  return (roll / kTwoPi + 0.5) * rolls_;
}

std::uint32_t RotationCells::roll_id(double roll) const {
  return std::min(static_cast<std::uint32_t>(std::max(roll, 0.0)), rolls_ - 1);
}

std::uint32_t RotationCells::id(const Eigen::Matrix3d& R) const {
  const std::uint32_t direction = direction_id(R.col(2));
  return direction * rolls_ + roll_id(roll_at(R, direction));
}

/// Cosine of half the angle to the nearest direction of the cell, from above: taken from the side it is farthest
/// outside of.
double RotationCells::cos_half_gap(const Eigen::Vector3d& direction, std::uint32_t cell) const {
  double sine = 0;
  for (const Eigen::Vector3d& side : sides_[cell]) sine = std::max(sine, -side.dot(direction));
  return std::sqrt(0.5 + 0.5 * std::sqrt(std::max(0.0, 1 - sine * sine)));
}

/// Upper bound of what carrying over the cell's middle changes a roll, against carrying straight to any point of the
/// cell: the area of the largest spherical triangle with these two sides.
double RotationCells::roll_error(const Eigen::Vector3d& direction, std::uint32_t cell) const {
  const double cosine = direction.dot(centres_[cell]);
  const double half_tangents = std::sqrt(std::max(0.0, 1 - cosine) / (1 + cosine)) * half_radius_tangents_[cell];
  return 2 * std::asin(std::min(1.0, half_tangents));
}

int RotationCells::near_cells(const Eigen::Matrix3d& R, NearCells& cells) const {
  const double roll_width = kTwoPi / rolls_;
  const Eigen::Vector3d z = R.col(2);
  const std::uint32_t own = direction_id(z);
  int count = 0;
  for (std::uint32_t n = neighbours_first_[own]; n < neighbours_first_[own + 1]; ++n) {
    const std::uint32_t direction = neighbours_[n];
    const double roll = roll_at(R, direction), error = roll_error(z, direction);
    const double cos_half = cos_half_gap(z, direction);
    const std::uint32_t middle = roll_id(roll);
    const auto add = [&](std::uint32_t roll_cell, double gap) {
      // The angle of a rotation made of a swing and a roll about perpendicular axes: both halves' cosines multiply.
      const double roll_gap = std::max(0.0, gap * roll_width - error);
      cells[count++] = {direction * rolls_ + roll_cell,
                        2 * std::acos(std::min(1.0, cos_half * std::cos(roll_gap / 2)))};
    };
    add(middle, 0);
    add((middle + rolls_ - 1) % rolls_, roll - middle);
    add((middle + 1) % rolls_, middle + 1 - roll);
  }
  std::sort(cells.begin(), cells.begin() + count,
            [](const NearCell& a, const NearCell& b) { return a.angle < b.angle; });
  return count;
}

}  // namespace mmgrasp::detail
