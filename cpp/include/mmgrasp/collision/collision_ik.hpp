#pragma once

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/core/export.hpp"
#include "mmgrasp/robot/ik.hpp"

namespace mmgrasp {

/// solve_ik whose solutions are collision-free according to the checker (of the same group).
MMGRASP_EXPORT IkResult solve_collision_free_ik(CollisionChecker& checker, const Pose& T_world_tip,
                                                const Eigen::VectorXd& seed, const IkOptions& options = {},
                                                const Monitor& monitor = {});

}  // namespace mmgrasp
