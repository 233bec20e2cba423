#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace mmgrasp::detail {

/// Cells of nearly equal size over all rotations: the direction of the tool's z axis on a cube whose six faces carry an
/// equiangular grid (solid angles differ by at most sqrt 2), times the roll about it. Roll is measured at the cell's middle,
/// where the rotation is carried along the shortest arc: two rotations close to each other get close rolls everywhere.
class RotationCells {
 public:
  explicit RotationCells(double cell);

  std::uint32_t count() const { return directions() * rolls_; }
  std::uint32_t directions() const { return static_cast<std::uint32_t>(centres_.size()); }
  std::uint32_t rolls() const { return rolls_; }

  /// direction cell * rolls() + roll cell.
  std::uint32_t id(const Eigen::Matrix3d& R) const;
  std::uint32_t direction_id(const Eigen::Vector3d& direction) const;
  /// Roll cell of R carried to the middle of a direction cell; the cell must not lie opposite R's z axis.
  std::uint32_t roll_id(const Eigen::Matrix3d& R, std::uint32_t direction) const;

  /// Direction cells that share a corner or an edge with this one, itself first.
  const std::uint32_t* neighbours_begin(std::uint32_t direction) const {
    return neighbours_.data() + neighbours_first_[direction];
  }
  const std::uint32_t* neighbours_end(std::uint32_t direction) const {
    return neighbours_.data() + neighbours_first_[direction + 1];
  }
  static constexpr int kMaxNeighbours = 9;

  /// Lower bound of the angle between a unit direction and any direction of the cell [rad].
  double angle_to(const Eigen::Vector3d& direction, std::uint32_t cell) const;

 private:
  Eigen::Vector3d direction_at(std::uint32_t face, double i, double j) const;
  void add_cell(std::uint32_t face, std::uint32_t i, std::uint32_t j);
  void add_neighbours(std::uint32_t cell);

  std::uint32_t side_ = 1;    ///< Cells along the edge of a face.
  std::uint32_t rolls_ = 3;
  std::vector<Eigen::Vector3d> centres_;
  std::vector<Eigen::Vector3d> roll_zero_;   ///< Unit, orthogonal to the centre: where the tool's x axis has roll 0.
  std::vector<double> radii_;                ///< Largest angle between the centre and a point of the cell.
  std::vector<std::uint32_t> neighbours_, neighbours_first_;
};

}  // namespace mmgrasp::detail
