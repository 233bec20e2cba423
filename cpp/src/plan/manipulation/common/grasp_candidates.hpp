#pragma once

#include <vector>

#include "mmgrasp/core/detail/stopwatch.hpp"
#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/plan/manipulation.hpp"
#include "mmgrasp/robot/detail/joint_metric.hpp"
#include "mmgrasp/robot/detail/whole_turns.hpp"
#include "plan/manipulation/common/transfer_checks.hpp"

namespace mmgrasp::detail {

/// A grasp with arm configurations at both ends.
struct MMGRASP_EXPORT GraspCandidate {
  int grasp = -1;
  int opening = 0;
  double cost = 0;
  std::vector<Eigen::VectorXd> starts, goals;
  JointMetric metric;    ///< Measures distances between configurations.
  int turned_goals = 0;  ///< How many of the goals are whole turns of others.
  /// Proven: paths with this grasp begin and end in these arm postures, in any of their turns, and in no others.
  bool all_postures = false;
  /// Least cost any path with this grasp can have: the straight line between its nearest start and goal.
  double straight_cost() const;
};

/// The grasps of a problem with arm configurations at both ends (P2 4.3.2.3, with several solutions). They are found a
/// few at a time, in an order drawn by the seed: a planner can search those it has before more are found.
class GraspCandidates {
 public:
  /// Writes a report for each grasp, and the time spent, to `result`.
  GraspCandidates(const ManipulationProblem& problem, const ManipulationOptions& options, const JointMetric& metric,
                  TransferChecks& checks, const Stopwatch& clock, const Monitor& monitor, ManipulationResult& result);

  /// Those found so far; find_more() adds at the end.
  const std::vector<GraspCandidate>& found() const { return found_; }
  /// Checks `count` more grasps, or all that are left. False when none was left, or when stopped or out of time.
  bool find_more(std::size_t count);
  bool find_rest();
  /// Every grasp was checked.
  bool complete() const { return checked_ == order_.size(); }
  /// A lower bound on paths with any grasp not yet checked; infinite when all are.
  double least_cost_left() const;
  /// A lower bound on paths between the arm postures found, with any grasp: straight lines of those found, grasp costs
  /// of those not yet checked.
  double least_cost() const;
  /// A lower bound on paths that begin or end in an arm posture which was not checked; infinite when all were.
  double least_cost_elsewhere() const { return least_cost_elsewhere_; }

  /// What touches at the start (or goal) with the first grasp that reports a collision there; empty when none does.
  std::vector<Contact> first_contacts(bool at_goal);

 private:
  GraspCandidate check(int grasp, int worker, GraspReport& report);
  /// A lower bound on paths with the grasp, whatever the arm postures at their ends.
  double least_cost_from_anywhere(int grasp) const;
  /// No path that costs as much is of interest: the result's cost.
  double bound() const;
  /// Adds the turns of the ends found before there was a path that bounds them.
  void add_left_out_turns();

  const ManipulationProblem& problem_;
  const ManipulationOptions& options_;
  const JointMetric& metric_;
  TransferChecks& checks_;
  const Stopwatch& clock_;
  const Monitor& monitor_;
  ManipulationResult& result_;
  std::vector<int> order_;
  std::size_t checked_ = 0;  ///< How many of order_ were checked.
  std::vector<GraspCandidate> found_;
  double least_cost_elsewhere_;
  WholeTurns turns_;
  std::vector<GraspCandidate> unbounded_;  ///< The first of found_, in one turn each, found without a path.
};

}  // namespace mmgrasp::detail
