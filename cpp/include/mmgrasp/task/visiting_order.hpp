#pragma once

#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/task/base_sequence.hpp"
#include "mmgrasp/task/problem.hpp"

namespace mmgrasp {

/// An order of stops, or between which of them no drive was found.
struct MMGRASP_EXPORT VisitingOrder {
  std::vector<int> stops;  ///< Indices of the stops as they are visited; empty when one cannot be driven to.
  int unreachable = -1;    ///< Then: that stop's index, -1 for the goal.
  int from = -1;           ///< Where no drive to it was found from: a stop's index, -1 for the start.
};

/// The order in which the stops are visited from the problem's start to its goal, all parts in place. Up to 6 stops are
/// ordered by the lengths of planned drives. More are ordered by route_lengths(): the drives of the order found are
/// planned and replace the estimates until the order stays. Exact for these lengths up to 15 stops.
MMGRASP_EXPORT VisitingOrder order_stops(const PartSupplyProblem& problem, const std::vector<Stop>& stops,
                                         const Monitor& monitor = {});

}  // namespace mmgrasp
