#pragma once

#include <vector>

#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/plan/manipulation.hpp"
#include "plan/carry_checks.hpp"

namespace mmgrasp::detail {

/// A grasp with arm configurations at both ends.
struct CarryCandidate {
  int grasp = -1;
  int opening = 0;
  double cost = 0;
  std::vector<Eigen::VectorXd> starts, goals;
  /// Least cost any path with this grasp can have: the nearest pair of ends, straight.
  double straight_cost() const;
};

/// Solves IK for every grasp at both ends (P2 4.3.2.3, with several solutions) and keeps those with both; `reports`
/// gets one entry a grasp. False when stopped or out of time.
bool find_candidates(const ManipulationProblem& problem, const ManipulationOptions& options, CarryChecks& checks,
                     std::vector<CarryCandidate>& candidates, std::vector<GraspReport>& reports,
                     const Monitor& monitor);

/// What touches at the start (or goal) with the first grasp that reports a collision there; empty when none does.
std::vector<Contact> first_contacts(CarryChecks& checks, const ManipulationOptions& options,
                                    const std::vector<GraspReport>& reports, bool at_goal);

}  // namespace mmgrasp::detail
