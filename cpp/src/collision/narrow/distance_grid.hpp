#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "collision/kernels/kernels.hpp"
#include "mmgrasp/core/export.hpp"
#include "mmgrasp/geometry/mesh.hpp"

namespace mmgrasp::detail {

struct Solid;

/// A grid around a body that bounds the distance to it from below: what is farther than a sphere's radius misses the
/// sphere for certain. Cells that lie wholly within the body are marked. Immutable.
class MMGRASP_EXPORT DistanceGrid {
 public:
  /// The grid of a mesh; `solid` was made of it.
  DistanceGrid(const TriangleMesh& mesh, const Solid& solid);
  /// The grid of solid cells of one edge length: their own lattice as long as it is small enough, else a coarser one.
  DistanceGrid(const std::vector<Eigen::Vector3d>& centres, double resolution);

  GridView view() const;
  /// The point, in the body's frame, is at least this far from the body [m]; 0 when that is not known.
  double distance(const Eigen::Vector3d& point) const {
    const Eigen::Vector3d cell = (point - low_) * per_step_;
    if ((cell.array() < 0).any() || (cell.array() >= size_.array()).any()) return body_.exteriorDistance(point);
    const Eigen::Vector3d low(static_cast<int>(cell[0]), static_cast<int>(cell[1]), static_cast<int>(cell[2]));
    const int value = cells_[index(static_cast<int>(low[0]), static_cast<int>(low[1]), static_cast<int>(low[2]))];
    if (value <= 0) return 0;
    const double off_centre = (cell - low - Eigen::Vector3d::Constant(0.5)).norm();
    return std::max(0.0, value * quantum_ - spread_ * off_centre);
  }
  /// Largest coordinate of the grid [m].
  float extent() const { return extent_; }

 private:
  /// What a cell holds: one of these, or its distance from the body in quanta.
  enum Cell : std::int8_t { kSolidCell = -1, kSurfaceCell = 0 };

  void lay_out(const Eigen::AlignedBox3d& body, const Eigen::Vector3d& low, double step,
               const std::array<int, 3>& count, int quanta_per_cell);
  std::size_t index(int i, int j, int k) const { return (static_cast<std::size_t>(i) * count_[1] + j) * count_[2] + k; }
  /// Cells that the triangle may touch become kSurfaceCell.
  void mark(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c);
  /// Cells that cannot be reached from outside without crossing kSurfaceCell become kSurfaceCell, or kSolidCell where
  /// they lie inside the solid.
  void fill(const Solid& solid);
  /// Distance of the centres of kFree cells to the mesh where that is at most `band`; infinite elsewhere [m].
  std::vector<float> centre_distances(const TriangleMesh& mesh, double band) const;
  /// Replaces each entry by the squared distance of its cell to the nearest one whose entry is 0, in cells.
  void spread_out(std::vector<float>& squared) const;
  /// Turns kFree cells into distances of their centres; those of `near` are known, the rest is bounded from below.
  void measure_centres(const std::vector<float>& near, double band);
  /// Turns kFree cells into distances of their nearest points to the other cells.
  void measure_cells();

  Eigen::AlignedBox3d body_;
  Eigen::Vector3d low_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d size_ = Eigen::Vector3d::Zero();  ///< Number of cells along each axis.
  double step_ = 1, per_step_ = 1, quantum_ = 1;
  double spread_ = 0;  ///< Per distance from the cell's centre, in cells, that is to be taken off a value [m].
  std::array<int, 3> count_{{1, 1, 1}};
  std::vector<std::int8_t> cells_;
  float extent_ = 0;
};

}  // namespace mmgrasp::detail
