#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "grasp/synthesis/point_grid.hpp"
#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/robot/joint.hpp"

namespace mmgrasp::detail {

enum class HandContact { none, table, map };

/// Whether a hand's boxes keep apart from points with uncertain places, and from a level table below them. The points
/// are two voxels apart at most, so that nothing thicker slips between them.
class MMGRASP_EXPORT HandClearance {
 public:
  /// A surface with an uncertain distance may lie farther out along its normal, by `sigmas` times its sigma [m], and
  /// `margin` is kept around all of that way; without a normal (zero) it may lie so much farther in any direction.
  HandClearance(const std::vector<Eigen::Vector3d>& points, const std::vector<Eigen::Vector3d>& normals,
                const std::vector<double>& sigma, double sigmas, double margin, const std::optional<double>& table);

  /// How far the hand reaches below the table's top and the margin above it [m]; 0: it does not, or there is no table.
  double in_table(const std::vector<LinkShape>& boxes, const Pose& T_world_hand) const;
  /// The first thing that the boxes, given in the hand's frame, touch.
  HandContact check(const std::vector<LinkShape>& boxes, const Pose& T_world_hand) const;
  /// Whether a point lies deeper than this in one of the boxes [m], however uncertain its place.
  bool pierced(const std::vector<LinkShape>& boxes, const Pose& T_world_hand, double depth) const;

 private:
  bool touches(const Pose& T_world_box, const Eigen::Vector3d& half, const std::optional<double>& depth) const;

  /// What a point may take up: all within `around` of the way from `begin` to `begin` + `way`.
  struct Swept {
    Eigen::Vector3d begin, way;
    double around, radius;  ///< `radius` of the sphere around `begin` that holds it.
  };
  double margin_, largest_ = 0;  ///< Largest radius.
  std::optional<double> table_;
  PointGrid grid_;
  std::vector<Swept> swept_;  ///< Ordered as in the grid.
};

}  // namespace mmgrasp::detail
