#pragma once

#include <vector>

#include "gripper_design/gripper_candidates.hpp"

namespace mmgrasp::detail {

/// What covering parts costs at least: prices of parts, less what each candidate's parts are priced above its cost
/// (Lagrangian relaxation of the covering). Any prices >= 0 prove a bound; subgradient steps raise it.
class CoverPrices {
 public:
  explicit CoverPrices(const std::vector<GripperCandidate>& candidates);

  /// No choice among `allowed` covers the parts of `uncovered` for less. Begins with `prices` (one per part) and
  /// leaves the best ones there; ends early once the bound exceeds `enough`, which lengthens the steps as well.
  double raise(const Bits& allowed, const Bits& uncovered, int steps, double enough, std::vector<double>& prices);

  /// After raise(): what taking an allowed candidate adds to the bound; < 0: what leaving it out adds.
  double reduced_cost(int candidate) const { return reduced_[candidate]; }

 private:
  void reduce(const std::vector<double>& prices);
  double bound(const std::vector<double>& prices) const;

  const std::vector<GripperCandidate>& candidates_;
  std::vector<int> allowed_;             // Those that take something uncovered,
  std::vector<std::vector<int>> takes_;  // and the uncovered parts that each of all candidates takes.
  std::vector<int> uncovered_;
  std::vector<double> reduced_;
};

}  // namespace mmgrasp::detail
