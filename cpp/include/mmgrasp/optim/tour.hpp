#pragma once

#include <Eigen/Core>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/outcome.hpp"

namespace mmgrasp {

/// The order in which stops are visited, and how short any tour could be at best.
struct MMGRASP_EXPORT TourResult {
  /// infeasible: proven, up to 15 stops; not_found: the local search met no tour beyond.
  Outcome outcome = Outcome::not_found;
  std::vector<int> order;  ///< Visiting order of the stops, indices into 0..n-1.
  double length = 0;
  double lower_bound = 0;  ///< Proven: no tour is shorter. Infinite when it is proven that there is none.
  bool proven = false;     ///< The length meets the bound: always up to 15 stops, beyond when the bound is as good.
};

/// Shortest path start -> all stops -> goal. `lengths` is (n + 2) x (n + 2): stops first, then start, then goal; an
/// infinite entry means that no path leads from the one to the other. May be asymmetric. Exact up to 15 stops (Held and
/// Karp's dynamic programme); beyond, a local search with restarts, and a bound by spanning trees and by assignment.
/// Deterministic.
MMGRASP_EXPORT TourResult shortest_visiting_tour(const Eigen::MatrixXd& lengths);

}  // namespace mmgrasp
