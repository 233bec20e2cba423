#pragma once

#include "mmgrasp/plan/manipulation.hpp"

namespace mmgrasp::detail {

/// plan_manipulation with ManipulationOptions::max_length.
ManipulationResult plan_least_grasp_cost(const ManipulationProblem& problem, const ManipulationOptions& options,
                                         const Roadmap* roadmap, const Monitor& monitor,
                                         const ImprovementCallback& on_improvement, const CollisionChecker* checker);

}  // namespace mmgrasp::detail
