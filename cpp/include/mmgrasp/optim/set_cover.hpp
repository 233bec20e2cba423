#pragma once

#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/core/outcome.hpp"

namespace mmgrasp {

/// 0-1 programme of P1 (3.1): choose as few (or as cheap) sets as possible so that every element is covered.
///
///     const SetCoverResult result = solve_set_cover({4, {{0, 1}, {2, 3}, {1, 2}}, {}});  // sets 0 and 1, proven least
///
/// "As few sets as possible, and of those the best" is one problem: costs 1 + p_s with penalties p_s >= 0 that sum to
/// less than 1 over all sets, e.g. p_s = (1 - r_s / r_max) / (2 n) for n sets that should have large radii r_s. Then no
/// saving in penalties pays for another set. Totals that differ by less than about 1e-7 of the least cost, or 1e-9 of
/// their own, may count as equal.
struct MMGRASP_EXPORT SetCoverProblem {
  int elements = 0;
  std::vector<std::vector<int>> sets;  ///< Elements of each set, in [0, elements).
  std::vector<double> costs;           ///< One per set, > 0, at most 1e9 times the least; empty means 1 each.
  void check() const;
};

/// The sets chosen, with a proven bound on what any cover costs.
struct MMGRASP_EXPORT SetCoverResult {
  /// `solved` only with a proof of optimality; `approximate` with a cover but no proof; `stopped` by the monitor, with
  /// a cover and the bound known by then.
  Outcome outcome = Outcome::timeout;
  std::vector<int> chosen;  ///< Set indices, ascending.
  double cost = 0;
  double lower_bound = 0;        ///< Proven: no cover costs less.
  std::vector<int> uncoverable;  ///< Elements in no set; the outcome is then `infeasible`.
};

/// Reduces by dominance, then branch and bound with CBC. Deterministic; among equal optima the lexicographically
/// smallest is not promised, but the same problem always gives the same answer (unless the time limit ends the search).
/// Calls from several threads wait for each other, within their time limits: CBC keeps process-wide state. Throws
/// InvalidInput on bad indices, costs or time_limit <= 0.
MMGRASP_EXPORT SetCoverResult solve_set_cover(const SetCoverProblem& problem, double time_limit = 60.0,
                                              const Monitor& monitor = {});

}  // namespace mmgrasp
