#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace mmgrasp::detail {

/// Cells of nearly equal size over all rotations: the direction of the tool's z axis on a cube whose six faces carry an
/// equiangular grid (solid angles differ by at most sqrt 2), times the roll about it. Roll is measured at the cell's
/// middle, where the rotation is carried along the shortest arc: two rotations close to each other get close rolls
/// everywhere.
class RotationCells {
 public:
  explicit RotationCells(double cell);

  std::uint32_t count() const { return directions() * rolls_; }
  std::uint32_t directions() const { return static_cast<std::uint32_t>(centres_.size()); }
  std::uint32_t rolls() const { return rolls_; }

  /// direction cell * rolls() + roll cell.
  std::uint32_t id(const Eigen::Matrix3d& R) const;
  std::uint32_t direction_id(const Eigen::Vector3d& direction) const;

  /// A cell near a rotation, and a lower bound of the angle between that rotation and any in the cell [rad].
  struct NearCell {
    std::uint32_t id = 0;
    double angle = 0;
  };
  /// Nine direction cells at most touch in a corner or an edge, three rolls each.
  static constexpr int kMostNear = 27;
  using NearCells = std::array<NearCell, kMostNear>;
  /// The cell of R and those around it: direction cells that share a corner with R's, with the three nearest rolls
  /// each, nearest bound first. Returns how many.
  int near_cells(const Eigen::Matrix3d& R, NearCells& cells) const;

 private:
  /// Roll of R carried to the middle of a direction cell, in [0, rolls()]; the cell must not lie opposite R's z axis.
  double roll_at(const Eigen::Matrix3d& R, std::uint32_t direction) const;
  std::uint32_t roll_id(double roll) const;
  double cos_half_gap(const Eigen::Vector3d& direction, std::uint32_t cell) const;
  double roll_error(const Eigen::Vector3d& direction, std::uint32_t cell) const;
  Eigen::Vector3d direction_at(std::uint32_t face, double i, double j) const;
  void add_cell(std::uint32_t face, std::uint32_t i, std::uint32_t j);
  void add_neighbours(std::uint32_t cell);

  std::uint32_t side_ = 1;  ///< Cells along the edge of a face.
  std::uint32_t rolls_ = 3;
  std::vector<Eigen::Vector3d> centres_;
  std::vector<Eigen::Vector3d> roll_zero_;  ///< Unit, orthogonal to the centre: where the tool's x axis has roll 0.
  std::vector<double>
      half_radius_tangents_;  ///< tan(r / 2), r the largest angle between the centre and a point of the cell.
  std::vector<std::array<Eigen::Vector3d, 4>> sides_;  ///< Inward unit normals of the great circles around the cell.
  std::vector<std::uint32_t> neighbours_, neighbours_first_;
};

}  // namespace mmgrasp::detail
