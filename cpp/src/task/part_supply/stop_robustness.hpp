#pragma once

#include <vector>

#include "mmgrasp/task/base_region.hpp"
#include "mmgrasp/task/base_sequence.hpp"

namespace mmgrasp {

struct RobustnessResult {
  bool stopped = false;
  std::size_t samples = 0, good = 0;
  std::size_t cells_removed = 0;
  std::string worst_part;  ///< The part that failed most often; empty when none did.
  double rate() const { return samples ? static_cast<double>(good) / static_cast<double>(samples) : 1.0; }
};

/// Draws base poses in the uncertainty disc of each stop and asks for every target part of its trays, random restarts
/// of IK included. A base pose that fails takes its cell out of the regions of the trays that failed there.
RobustnessResult check_robustness(const PartSupplyProblem& problem, const BasePoseEvaluator& evaluator,
                                  const BaseGrid& grid, const std::vector<Stop>& stops,
                                  const std::vector<int>& region_trays, std::vector<BaseRegion>& regions,
                                  const Monitor& monitor);

}  // namespace mmgrasp
