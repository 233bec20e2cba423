#pragma once

#include <limits>

#include "collision/solid.hpp"

namespace mmgrasp::detail {

/// True when a, placed at T_a, and b at T_b touch (or come within the sum of their margins). Closed meshes are solid.
bool solids_collide(const Solid& a, const Rigid& T_a, const Solid& b, const Rigid& T_b);

struct SolidGap {
  double distance = std::numeric_limits<double>::infinity();  ///< [m]; negative when they overlap (approximate).
  Eigen::Vector3d on_a = Eigen::Vector3d::Zero();             ///< World frame.
  Eigen::Vector3d on_b = Eigen::Vector3d::Zero();
};

/// Gap between the two, margins not counted. Exact below `bound`; above it the answer may be anything not below the
/// bound.
SolidGap solids_distance(const Solid& a, const Rigid& T_a, const Solid& b, const Rigid& T_b,
                         double bound = std::numeric_limits<double>::infinity());

}  // namespace mmgrasp::detail
