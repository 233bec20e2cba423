#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "grasp/synthesis/point_grid.hpp"
#include "mmgrasp/core/export.hpp"
#include "mmgrasp/grasp/success_model.hpp"
#include "mmgrasp/grasp/synthesize_grasps.hpp"
#include "mmgrasp/mapping/probabilistic_sdf.hpp"

namespace mmgrasp::detail {

/// Around an object's box that a hand may take up [m].
inline constexpr double kHandReach = 0.3;

/// The map's surface points apart: what is to be grasped, and all that a hand may touch. Points of the table are in
/// neither, the table being a plane, nor are pieces of surface too small to be a body, which noise leaves in the air.
class MMGRASP_EXPORT MapSurface {
 public:
  /// Throws InvalidInput for a map without a surface, or without one where the object should be.
  MapSurface(const ProbabilisticSdf& map, const SynthesisOptions& options);

  /// Mean normal of the object's points around that face the same way: single ones are noisy.
  Eigen::Vector3d mean_normal(std::size_t i) const;

  std::vector<Eigen::Vector3d> object, object_normal;
  std::vector<double> object_sigma;  ///< [m]
  std::vector<Eigen::Vector3d> scene,
      scene_normal;                 ///< The object's points among them; a normal is zero where there is none.
  std::vector<double> scene_sigma;  ///< [m]
  ObjectExtent extent;
  double diagonal = 0;  ///< Diagonal of the axis-aligned box of the object's points [m].

 private:
  std::optional<PointGrid> grid_;
};

/// The box of least ground area among those turned about the vertical axis; `floor` is the height that it stands on, or
/// NaN: the lowest point.
MMGRASP_EXPORT ObjectExtent fit_extent(const std::vector<Eigen::Vector3d>& points, double floor);

}  // namespace mmgrasp::detail
