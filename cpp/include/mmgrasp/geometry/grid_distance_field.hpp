#pragma once

#include <array>
#include <vector>

#include "mmgrasp/geometry/distance_field.hpp"

namespace mmgrasp {

/// Signed distances at the points of a regular grid; between them they are interpolated linearly along each axis.
///
///     GridDistanceField::Grid grid;
///     grid.size = {{100, 100, 50}};
///     grid.values = distances;  // z changes fastest
///     const GridDistanceField field(grid);
///     const double clearance = field.distance({0.5, 0.5, 0.2});  // NaN: not known
///
/// Known inside the grid, where none of the up to eight points around is NaN. The distance changes by at most the way
/// walked, so what is interpolated is off by at most sqrt(3) / 2 of the spacing, in the middle of a cell; with the
/// error of the values themselves that is the error the field states. Near flat surfaces it is far smaller.
class MMGRASP_EXPORT GridDistanceField : public DistanceField {
 public:
  struct Grid {
    std::array<int, 3> size{{0, 0, 0}};                           ///< Points along x, y, z; at least 2 each.
    std::vector<double> values;                                   ///< [m]; z changes fastest. NaN: not known.
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();             ///< First point [m].
    double spacing = 0.01;                                        ///< [m]; > 0.
    double error = 0;                                             ///< Largest error of the values [m]; >= 0.
    double truncation = std::numeric_limits<double>::infinity();  ///< See DistanceFieldProperties [m]; > 0.
    void check() const;                                           ///< Throws InvalidInput.
  };

  explicit GridDistanceField(Grid grid);
  DistanceFieldProperties properties() const override;
  const Grid& grid() const { return grid_; }

 private:
  void evaluate(const Eigen::Matrix3Xd& points, Eigen::VectorXd& distances, Eigen::Matrix3Xd* gradients) const override;

  Grid grid_;
};

}  // namespace mmgrasp
