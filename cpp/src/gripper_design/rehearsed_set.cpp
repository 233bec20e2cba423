// The least set of grippers with which every operation was gone through: chosen, rehearsed, and chosen again without
// the grasps that a rehearsal refused.
#include "gripper_design/rehearsed_set.hpp"

#include <algorithm>
#include <utility>

#include "gripper_design/counted_texts.hpp"
#include "gripper_design/millimetres.hpp"
#include "gripper_design/set_options.hpp"
#include "mmgrasp/core/detail/stopwatch.hpp"
#include "mmgrasp/core/parallel.hpp"
#include "mmgrasp/gripper_design/rehearse_operation.hpp"

namespace mmgrasp::detail {
namespace {

std::string grasps(std::size_t count) {
  return std::to_string(count) + (count == 1 ? " grasp" : " grasps");
}

}  // namespace

void RehearsedSet::find() {
  choose_until_nothing_is_met();
  if (task_.options.holding && result_.set && !result_.set->grippers.empty()) write_real_pads();
}

void RehearsedSet::choose_until_nothing_is_met() {
  while (choose()) {
    if (!rehearse()) return;
    const auto nothing = [](const std::string& met) { return met.empty(); };
    if (std::all_of(result_.met.begin(), result_.met.end(), nothing)) return;
    result_.outcome = Outcome::not_found;
    if (!leave_refused_out() || result_.rehearsals >= task_.options.max_rehearsals) return;
  }
}

/// Chooses a set for the grasps that are left; false where there is none, which is the outcome.
bool RehearsedSet::choose() {
  const std::vector<int> left = pool_.left();
  std::vector<SegmentRequirement> requirements;
  for (const int r : left) requirements.push_back(result_.requirements[r]);
  MinimalGrippersOptions options = set_options(task_.options);
  options.time_limit = std::max(options.time_limit - seconds_, 1e-3);
  const Stopwatch stopwatch;
  MinimalGrippersResult found =
      preferred_grippers(requirements, pool_.values(left), task_.actuators, options, monitor_);
  seconds_ += stopwatch.seconds();
  // What was left out might have been taken by a drive: that there is no set without it proves nothing.
  const bool unproven = found.outcome == Outcome::infeasible && !result_.left_out.empty();
  result_.outcome = unproven ? Outcome::not_found : found.outcome;
  for (int& r : found.requirement_of_part) r = left[r];
  const bool has_set = !found.grippers.empty();
  if (has_set || !result_.set) {
    result_.set = std::move(found);
  } else {
    for (std::size_t i = 0; i < found.uncovered.size(); ++i) {
      const std::string refused = refused_of(found.uncovered[i]);
      result_.missing.push_back(found.explanations[i] +
                                (refused.empty() ? "" : "; other grasps are refused by its rehearsal: " + refused));
    }
  }
  return has_set;
}

/// Goes through every operation; false when it was stopped.
bool RehearsedSet::rehearse() {
  const std::size_t count = task_.operations.size();
  std::vector<std::string> met(count);
  const std::string stage =
      result_.left_out.empty() ? "rehearsal" : "rehearsal, " + grasps(result_.left_out.size()) + " left out";
  const auto work = [&](std::size_t i, int) { met[i] = gone_through(i); };
  if (!parallel_for(count, task_.options.threads, work, monitor_, stage.c_str())) {
    result_.outcome = Outcome::stopped;
    result_.met.clear();  // What was not gone through has not met nothing.
    return false;
  }
  ++result_.rehearsals;
  result_.met = std::move(met);
  for (std::size_t i = 0; i < count; ++i) known_[rehearsal_of(i)] = result_.met[i];
  return true;
}

/// Leaves out the grasps by which something was met; false when an operation has none left.
bool RehearsedSet::leave_refused_out() {
  for (std::size_t i = 0; i < task_.operations.size(); ++i) {
    if (result_.met[i].empty()) continue;
    const int refused = result_.set->requirement_of_part[i];
    result_.left_out.push_back({refused, result_.met[i]});
    pool_.leave_out(refused);
  }
  const std::vector<std::string> without = operations_without_grasp();
  for (const std::string& name : without) {
    result_.missing.push_back(name + ": its rehearsal refuses every grasp: " + refused_of(name));
  }
  return without.empty();
}

/// What the refused grasps of an operation met; empty where there are none.
std::string RehearsedSet::refused_of(const std::string& operation) const {
  CountedTexts causes;
  for (const RefusedGrasp& r : result_.left_out)
    if (result_.requirements[r.requirement].part == operation) causes.add(r.met);
  return causes.joined();
}

std::vector<std::string> RehearsedSet::operations_without_grasp() const {
  std::vector<std::string> out;
  const std::vector<int> left = pool_.left();
  for (const AssemblyOperation& o : task_.operations) {
    const auto of_it = [&](int r) { return result_.requirements[r].part == o.name; };
    if (std::none_of(left.begin(), left.end(), of_it)) out.push_back(o.name);
  }
  return out;
}

/// What is said of the grasps chosen is of the pads that their grippers have.
void RehearsedSet::write_real_pads() {
  for (std::size_t i = 0; i < task_.operations.size(); ++i) {
    const int taken = result_.set->requirement_of_part[i];
    result_.holdings[taken] = held(i);
    result_.grasps[taken] = grasp_of(i);
  }
}

const Gripper& RehearsedSet::gripper_of(std::size_t operation) const {
  return result_.set->grippers[result_.set->gripper_of_part[operation]];
}

AssemblyGrasp RehearsedSet::grasp_of(std::size_t operation) const {
  return with_real_pad(result_.grasps[result_.set->requirement_of_part[operation]], gripper_of(operation));
}

HeldLoad RehearsedSet::held(std::size_t operation) const {
  return held_load(grasp_of(operation), task_.loads.at(task_.operations[operation].name));
}

RehearsedSet::Rehearsal RehearsedSet::rehearsal_of(std::size_t operation) const {
  const Gripper& g = gripper_of(operation);
  return {operation, result_.set->requirement_of_part[operation], g.min_opening, g.max_opening, g.finger_length};
}

/// What became of an operation with the gripper chosen for it.
std::string RehearsedSet::gone_through(std::size_t operation) const {
  const Gripper& gripper = gripper_of(operation);
  if (task_.options.holding && held(operation).safety < task_.options.holding->least_safety)
    return "pads slip: those of " + gripper.name + ", " + millimetres(gripper.pad_width()) +
           " wide, do not hold weight and insertion";
  const auto known = known_.find(rehearsal_of(operation));
  if (known != known_.end()) return known->second;
  return rehearse_operation(gripper, grasp_of(operation), task_.operations[operation]);
}

}  // namespace mmgrasp::detail
