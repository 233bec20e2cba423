#pragma once

#include <optional>
#include <vector>

#include "mmgrasp/core/monitor.hpp"
#include "task/base_route/base_moves.hpp"

namespace mmgrasp::detail {

struct BaseSearchSettings {
  BaseKind base = BaseKind::diff_drive;
  double resolution = 0.1;
  double turn_weight = 0.5;  // cost of a turn [m/rad]
  Eigen::AlignedBox2d bounds;
};

/// Lattice A* from one base pose to another; poses joined by primitive motions, all checked. Nothing when there is no
/// way.
std::optional<std::vector<Eigen::Vector3d>> search_base_path(BaseClearance& clearance, const Eigen::Vector3d& from,
                                                             const Eigen::Vector3d& to,
                                                             const BaseSearchSettings& settings,
                                                             const Monitor& monitor);

}  // namespace mmgrasp::detail
