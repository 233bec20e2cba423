#pragma once

#include <utility>
#include <vector>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/trajopt/whole_body_trajectory.hpp"

namespace mmgrasp::detail {

/// Where check_whole_body() finds collisions: intervals, and the fraction of each in [0, 1]. `checkers` as there.
std::vector<std::pair<int, double>> collision_places(const WholeBodyTrajectory& trajectory,
                                                     const std::vector<CollisionChecker*>& checkers);

}  // namespace mmgrasp::detail
