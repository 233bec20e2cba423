#pragma once

#include <Eigen/Core>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/outcome.hpp"

namespace mmgrasp {

/// Stops shared among several robots.
struct MMGRASP_EXPORT SharedTours {
  /// solved: proven least; approximate: a good one with a bound; infeasible: proven that none ends; else not_found.
  Outcome outcome = Outcome::not_found;
  std::vector<std::vector<int>> orders;  ///< The stops of each robot in visiting order; empty: it stays where it is.
  std::vector<double> durations;         ///< One a robot; 0 when it stays.
  double makespan = 0;                   ///< The longest.
  double lower_bound = 0;  ///< Proven: no sharing ends earlier. Infinite when it is proven that none ends.
};

/// Shares out the stops of one static sequence (P1 3.6.3) so that the last robot is done as early as can be: each
/// drives from its start over its stops to its goal and spends `stop_times` there. `drive_times` is (n + 2k) x (n +
/// 2k): n stops, then k starts, then k goals; may be asymmetric, infinite means "no way". Exact up to 12 stops (dynamic
/// programme over subsets); beyond, one tour is cut up and stops change robots while that helps. Waiting for each other
/// is not checked. Throws InvalidInput on sizes that do not fit, negative or undefined times.
MMGRASP_EXPORT SharedTours share_stops(const Eigen::MatrixXd& drive_times, const std::vector<double>& stop_times,
                                       int robots);

}  // namespace mmgrasp
