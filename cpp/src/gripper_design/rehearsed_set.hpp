#pragma once

#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "gripper_design/grasp_pool.hpp"
#include "mmgrasp/gripper_design/plan_grippers.hpp"

namespace mmgrasp::detail {

/// What a set of grippers is chosen and rehearsed for.
struct SetTask {
  const std::vector<AssemblyOperation>& operations;
  const std::vector<GripperActuator>& actuators;
  const PlanGrippersOptions& options;
  const std::map<std::string, OperationLoad>& loads;  ///< Keys are operations; only where holding is asked.
};

/// Chooses the least set and goes through every operation with it. Grasps that a rehearsal refuses are left out, and
/// the set is chosen again, until nothing is met, an operation has no grasp left, or `max_rehearsals` are over.
class RehearsedSet {
 public:
  RehearsedSet(const SetTask& task, GraspPool& pool, PlanGrippersResult& result, const Monitor& monitor)
      : task_(task), pool_(pool), result_(result), monitor_(monitor) {}

  /// Writes set, outcome, what was met and what was left out into the result.
  void find();

 private:
  void choose_until_nothing_is_met();
  bool choose();
  bool rehearse();
  bool leave_refused_out();
  std::vector<std::string> operations_without_grasp() const;
  std::string refused_of(const std::string& operation) const;
  void write_real_pads();
  const Gripper& gripper_of(std::size_t operation) const;
  AssemblyGrasp grasp_of(std::size_t operation) const;
  HeldLoad held(std::size_t operation) const;
  std::string gone_through(std::size_t operation) const;

  /// An operation, the requirement that it is done by, and lengths of the gripper.
  using Rehearsal = std::tuple<std::size_t, int, double, double, double>;
  Rehearsal rehearsal_of(std::size_t operation) const;

  const SetTask task_;
  GraspPool& pool_;
  PlanGrippersResult& result_;
  const Monitor& monitor_;
  double seconds_ = 0;                      // That searches for sets have taken.
  std::map<Rehearsal, std::string> known_;  // What was met by operations that were gone through before.
};

}  // namespace mmgrasp::detail
