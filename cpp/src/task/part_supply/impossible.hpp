#pragma once

#include "mmgrasp/task/base_pose_evaluator.hpp"
#include "mmgrasp/task/problem.hpp"

namespace mmgrasp::detail {

/// Proof that no plan exists: some target part of the tray can be grasped from no base pose with no arm configuration,
/// because each of its grasps (if there are any) lies beyond the arm's longest reach wherever the base stands, or the
/// open hand alone hits the scene there, all other parts gone. False proves nothing.
bool grasp_is_impossible(const PartSupplyProblem& problem, const BasePoseEvaluator& evaluator, TrayId tray);

}  // namespace mmgrasp::detail
