#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <vector>

#include "mmgrasp/core/random.hpp"
#include "mmgrasp/task/base_pose_evaluator.hpp"
#include "mmgrasp/task/base_region.hpp"
#include "mmgrasp/task/base_sequence.hpp"

namespace mmgrasp::detail {

/// How many of the base poses drawn at one stop serve all its parts.
struct StopShare {
  std::size_t samples = 0, good = 0;
  double rate() const { return samples ? static_cast<double>(good) / static_cast<double>(samples) : 1.0; }
};

/// A base pose from which a part of a stop's trays cannot be grasped; `part` is empty where the robot cannot even
/// stand.
struct Miss {
  TrayId tray;
  std::string part;
  Eigen::Vector3d pose;
};

/// What base poses drawn at some stops gave.
struct StopSamples {
  bool stopped = false;
  std::vector<StopShare> stops;
  std::vector<std::vector<Miss>> misses;  ///< One list for each stop.
};

/// Where the base comes to stand when it drives to a stop.
using DrawBasePose = std::function<Eigen::Vector3d(const Stop& stop, Rng& rng)>;

/// Draws `samples` base poses at each stop and counts those where the robot can stand at home and grasp every target
/// part of the stop's trays, random restarts of IK included. `seed` and the number of a draw decide it, so that the
/// answer is the same at any thread count; `common` draws are the same at every stop.
StopSamples sample_base_poses(const PartSupplyProblem& problem, const BasePoseEvaluator& evaluator,
                              const std::vector<Stop>& stops, std::size_t samples, std::uint64_t seed, bool common,
                              const DrawBasePose& draw, const Monitor& monitor);

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
