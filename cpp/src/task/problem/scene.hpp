#pragma once

#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/task/ids.hpp"
#include "mmgrasp/task/problem.hpp"

namespace mmgrasp::detail {

inline const Tray& tray_of(const PartSupplyProblem& problem, TrayId tray) {
  return problem.trays[tray];
}
inline const Part& part_of(const PartSupplyProblem& problem, PartRef part) {
  return tray_of(problem, part.tray).parts[part.part];
}

/// Every tray, in order.
std::vector<TrayId> all_trays(const PartSupplyProblem& problem);
/// Every part of every tray, in order.
std::vector<PartRef> all_parts(const PartSupplyProblem& problem);
/// The target parts of one tray, in order.
std::vector<PartRef> target_parts(const PartSupplyProblem& problem, TrayId tray);

/// ik_seeds_of_a_grasp() of the target parts.
MMGRASP_EXPORT int ik_seeds_of_a_grasp(const PartSupplyProblem& problem);

/// The scene with these parts in place.
World world_with_parts(const PartSupplyProblem& problem, const std::vector<PartRef>& parts);

/// The same with an object of it held by the tool, which only the finger links may touch.
World world_holding(World world, const Hand& gripper, const std::string& object, const Pose& T_hand_object);

/// The arm with the gripper's fingers opened so far [m]; everything else as in the arm's reference.
JointGroup arm_with_opening(const JointGroup& arm, const Hand& gripper, double opening);

}  // namespace mmgrasp::detail
