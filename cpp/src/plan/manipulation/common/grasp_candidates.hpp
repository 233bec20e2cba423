#pragma once

#include <vector>

#include "mmgrasp/core/detail/stopwatch.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/plan/manipulation.hpp"
#include "plan/manipulation/common/transfer_checks.hpp"

namespace mmgrasp::detail {

/// A grasp with arm configurations at both ends.
struct GraspCandidate {
  int grasp = -1;
  int opening = 0;
  double cost = 0;
  std::vector<Eigen::VectorXd> starts, goals;
  /// Least cost any path with this grasp can have: the nearest pair of ends, straight.
  double straight_cost() const;
};

/// The grasps of a problem with arm configurations at both ends (P2 4.3.2.3, with several solutions), found for some
/// more of them at a time, in an order drawn by the seed: a planner can search those it has before it asks for others.
class GraspCandidates {
 public:
  /// `result` gets a report for each grasp, and the time spent.
  GraspCandidates(const ManipulationProblem& problem, const ManipulationOptions& options, TransferChecks& checks,
                  const Stopwatch& clock, const Monitor& monitor, ManipulationResult& result);

  /// Those found so far; find_more() adds at the end.
  const std::vector<GraspCandidate>& found() const { return found_; }
  /// Looks at so many more grasps, or all that are left. False when none was left, or when stopped or out of time.
  bool find_more(std::size_t count);
  bool find_rest() { return find_more(order_.size()); }
  /// Every grasp was looked at.
  bool complete() const { return seen_ == order_.size(); }
  /// No path with any grasp not yet looked at costs less; infinite when there is none.
  double least_cost_left() const;
  /// No path with any grasp costs less: straight lines of those found, costs of those not yet looked at.
  double least_cost() const;

  /// What touches at the start (or goal) with the first grasp that reports a collision there; empty when none does.
  std::vector<Contact> first_contacts(bool at_goal);

 private:
  GraspCandidate look_at(int grasp, int worker, GraspReport& report);

  const ManipulationProblem& problem_;
  const ManipulationOptions& options_;
  TransferChecks& checks_;
  const Stopwatch& clock_;
  const Monitor& monitor_;
  ManipulationResult& result_;
  std::vector<int> order_;
  std::size_t seen_ = 0;  ///< Of order_: how many were looked at.
  std::vector<GraspCandidate> found_;
};

}  // namespace mmgrasp::detail
