#pragma once

#include <utility>
#include <vector>

#include "mmgrasp/task/problem.hpp"

namespace mmgrasp {

/// (tray, part) indices of every part.
std::vector<std::pair<int, int>> all_parts(const PartSupplyProblem& problem);

/// The scene with these parts in place.
World world_with_parts(const PartSupplyProblem& problem, const std::vector<std::pair<int, int>>& parts);

/// The arm with its fingers opened so far [m]; everything else as in the problem's reference.
JointGroup arm_with_opening(const PartSupplyProblem& problem, double opening);

inline const Part& part_of(const PartSupplyProblem& problem, int tray, int part) {
  return problem.trays[tray].parts[part];
}

}  // namespace mmgrasp
