#pragma once

#include <vector>

#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/core/outcome.hpp"
#include "task/base_route/base_moves.hpp"

namespace mmgrasp::detail {

struct BaseSearchSettings {
  BaseKind base = BaseKind::diff_drive;
  double resolution = 0.1;
  double turn_weight = 0.5;  // cost of a turn [m/rad]
  Eigen::AlignedBox2d bounds;
};

struct FoundBasePath {
  Outcome outcome = Outcome::not_found;  ///< Timeout: the budget of base poses ended before every way was tried.
  std::vector<Eigen::Vector3d> poses;    ///< When solved.
};

/// Lattice A* from one base pose to another; poses joined by primitive motions, all checked. A search that takes long
/// looks from the other end whether that is walled in.
FoundBasePath search_base_path(BaseClearance& clearance, const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                               const BaseSearchSettings& settings, const Monitor& monitor);

}  // namespace mmgrasp::detail
