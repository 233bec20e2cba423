#pragma once

#include <vector>

#include "mmgrasp/core/export.hpp"
#include "task/part_supply/stop_robustness.hpp"

namespace mmgrasp::detail {

/// Counts the arrivals, of `samples` drawn by the problem's `arrival_covariance`, from which all parts of a stop can be
/// grasped. The errors drawn are the same at every stop, so that stops can be compared; `chosen` draws others than
/// those by which seek_likely_poses() has chosen, which would flatter what they chose.
MMGRASP_EXPORT StopSamples count_arrivals(const PartSupplyProblem& problem, const BasePoseEvaluator& evaluator,
                                          const std::vector<Stop>& stops, std::size_t samples, bool chosen,
                                          const Monitor& monitor);

/// Moves each stop to where most arrivals serve all its parts, as far as the cells that its trays share go and hold a
/// disc of the positioning uncertainty; no trays change their stop. Middles of cells, a cell and a half apart, are
/// compared, first all by few arrivals, then the best by more; a stop stays where it is unless a better pose passes
/// check_robustness().
MMGRASP_EXPORT void seek_likely_poses(const PartSupplyProblem& problem, const BasePoseEvaluator& evaluator,
                                      const BaseGrid& grid, const std::vector<BaseRegion>& regions,
                                      std::vector<Stop>& stops, double required_rate, const Monitor& monitor);

}  // namespace mmgrasp::detail
