#pragma once

#include <map>
#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/core/outcome.hpp"
#include "mmgrasp/task/base_region.hpp"
#include "mmgrasp/task/base_route.hpp"
#include "mmgrasp/task/base_sequence.hpp"
#include "mmgrasp/task/pick.hpp"
#include "mmgrasp/task/problem.hpp"

namespace mmgrasp {

/// Seconds of wall time a stage took.
struct MMGRASP_EXPORT StageTime { std::string stage; double seconds = 0; };

/// Why there is no plan, and what would help.
struct MMGRASP_EXPORT Obstruction {
  std::string tray, part;           ///< What blocks; part empty when the whole tray does.
  std::string stage;                ///< "grasp", "region", "robustness", "motion", "route".
  std::string message;              ///< One sentence a person can act on.
  double largest_uncertainty = -1;  ///< Largest positioning uncertainty that still works [m]; < 0: none does.
  double missing_reach = 0;         ///< How far the nearest allowed base pose falls short of the part [m]; 0: reach is not it.
};

struct MMGRASP_EXPORT PartSupplyPlan {
  Outcome outcome = Outcome::infeasible;
  BaseGrid grid;
  std::vector<BaseRegion> regions;          ///< One a tray with target parts (see region_trays).
  std::vector<int> region_trays;            ///< Tray index of each region.
  Intersections intersections;              ///< Tray indices in it refer to regions.
  std::vector<Stop> stops;                  ///< In visiting order; tray indices refer to regions.
  int lower_bound = 0;                      ///< Proven least number of stops for these regions.
  std::vector<BasePath> route;              ///< stops.size() + 1 legs, from start to goal.
  std::vector<Pick> picks;                  ///< In the order carried out.
  double robustness_rate = 0;               ///< Share of sampled base poses at the stops from which all parts stay graspable.
  std::vector<Obstruction> obstructions;    ///< Empty if and only if solved.
  std::vector<StageTime> timings;
};

/// The whole of P1's Algorithm 1 and the motions around it. Every part of the answer is checked before it is returned.
/// Regions whose cells fail the sampled check between cell centres lose those cells, and the stops are solved again.
MMGRASP_EXPORT PartSupplyPlan plan_part_supply(const PartSupplyProblem& problem, const ReachDatabase& database,
                                               const Monitor& monitor = {});

}  // namespace mmgrasp
