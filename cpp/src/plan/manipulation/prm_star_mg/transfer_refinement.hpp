#pragma once

#include "plan/manipulation/common/manipulation_planner.hpp"

namespace mmgrasp::detail {

/// Makes the result's path cheaper, beyond P2, in rounds (PrmStarMgOptions::refinements). Each draws a small roadmap
/// where a cheaper path can pass, uniformly from the union of the informed ellipsoids of all grasps, searches it for
/// all grasps that can still win, and shortens what it finds, or else the best path once more. Many small roadmaps
/// find more than a large one does in the same time; they grow slowly, so that in the end no passage is too narrow.
/// Ends early when no grasp can win.
void refine_transfer(const ManipulationInput& input, ManipulationResult& result);

}  // namespace mmgrasp::detail
