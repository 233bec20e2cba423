#pragma once

#include <set>
#include <vector>

#include "gripper_design/segment_judgement.hpp"

namespace mmgrasp::detail {

/// The grasps that a set of grippers is chosen for: one requirement each, in the plan's result. Those that a rehearsal
/// refused are left out, and those that they had in reserve come in.
class GraspPool {
 public:
  GraspPool(PlanGrippersResult& result, bool with_holdings) : result_(result), with_holdings_(with_holdings) {}

  /// Takes up what was found of a segment; `fate` is its place in the result.
  void add(std::vector<FreeGrasp> found, std::size_t fate);

  /// Leaves a requirement out from now on.
  void leave_out(int requirement);

  /// Numbers of the requirements to choose among, those of an earlier operation first.
  std::vector<int> left() const;

  /// How good each of some requirements is: higher where the rank is better; equal ranks are worth the same.
  std::vector<double> values(const std::vector<int>& requirements) const;

 private:
  PlanGrippersResult& result_;
  bool with_holdings_;
  std::vector<GraspRank> ranks_;                    // One per requirement,
  std::vector<std::vector<FreeGrasp>> in_reserve_;  // as these,
  std::vector<std::size_t> fate_of_;                // and these.
  std::set<int> left_out_;
};

}  // namespace mmgrasp::detail
