#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "mmgrasp/task/base_pose_evaluator.hpp"
#include "mmgrasp/task/base_region.hpp"
#include "mmgrasp/task/base_sequence.hpp"

namespace mmgrasp::detail {

/// How many of the base poses drawn at one stop serve all its parts.
struct StopShare {
  std::size_t samples = 0, good = 0;
  double rate() const { return samples ? static_cast<double>(good) / static_cast<double>(samples) : 1.0; }
};

/// The same for all stops. Each is to be robust by itself: many good ones do not make up for a bad one.
struct RobustnessResult {
  bool stopped = false;
  std::vector<StopShare> stops;
  std::size_t cells_removed = 0;
  std::vector<std::string> worst_part;  ///< The part that failed most often at each stop; empty when none did.
  /// Least share of a stop; 1 without stops.
  double rate() const { return stops.empty() ? 1.0 : stops[worst_stop()].rate(); }
  /// Index of the stop with the least share; there must be one.
  std::size_t worst_stop() const {
    const auto less = [](const StopShare& a, const StopShare& b) { return a.rate() < b.rate(); };
    return std::min_element(stops.begin(), stops.end(), less) - stops.begin();
  }
};

/// Draws base poses in the uncertainty disc of each stop and checks that every target part of its trays can be grasped,
/// random restarts of IK included. The cell of a base pose that fails is removed from the regions (one a tray) of the
/// trays that failed there.
RobustnessResult check_robustness(const PartSupplyProblem& problem, const BasePoseEvaluator& evaluator,
                                  const BaseGrid& grid, const std::vector<Stop>& stops,
                                  std::vector<BaseRegion>& regions, const Monitor& monitor);

}  // namespace mmgrasp::detail
