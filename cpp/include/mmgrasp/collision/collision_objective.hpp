#pragma once

#include <memory>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/core/export.hpp"
#include "mmgrasp/robot/ik_objective.hpp"

namespace mmgrasp {

/// Keeps links away from each other (P3 5.8): weight x sum over self pairs nearer than `margin` [m] of
/// (1 - distance / margin)^2. The checker is cloned.
MMGRASP_EXPORT std::shared_ptr<const IkObjective> make_self_distance_objective(const CollisionChecker& checker,
                                                                               double margin = 0.05,
                                                                               double weight = 1.0);

}  // namespace mmgrasp
