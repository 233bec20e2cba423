#pragma once

#include <vector>

#include "mmgrasp/task/base_pose_evaluator.hpp"
#include "mmgrasp/task/base_region.hpp"
#include "mmgrasp/task/base_sequence.hpp"

namespace mmgrasp::detail {

/// How many of the base poses drawn at the stops serve all their parts.
struct RobustnessResult {
  bool stopped = false;
  std::size_t samples = 0, good = 0;
  std::size_t cells_removed = 0;
  std::string worst_part;  ///< The part that failed most often; empty when none did.
  double rate() const { return samples ? static_cast<double>(good) / static_cast<double>(samples) : 1.0; }
};

/// Draws base poses in the uncertainty disc of each stop and checks that every target part of its trays can be grasped,
/// random restarts of IK included. The cell of a base pose that fails is removed from the regions (one a tray) of the
/// trays that failed there.
RobustnessResult check_robustness(const PartSupplyProblem& problem, const BasePoseEvaluator& evaluator,
                                  const BaseGrid& grid, const std::vector<Stop>& stops,
                                  std::vector<BaseRegion>& regions, const Monitor& monitor);

}  // namespace mmgrasp::detail
