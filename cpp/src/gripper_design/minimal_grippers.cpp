#include "mmgrasp/gripper_design/minimal_grippers.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "gripper_design/counted_texts.hpp"
#include "gripper_design/fewest_changes.hpp"
#include "gripper_design/gripper_candidates.hpp"
#include "gripper_design/gripper_set.hpp"
#include "gripper_design/millimetres.hpp"
#include "mmgrasp/core/detail/lengths.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/detail/stopwatch.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/optim/set_cover.hpp"

namespace mmgrasp {
namespace {

using namespace detail;

constexpr int kMaxRequirements = 100000;
constexpr int kMaxGrid = 10000;

std::string exactly(double length) {
  return millimetres(length, 10);
}

/// Why no drive takes a segment.
std::string refusal(const SegmentRequirement& requirement, const std::vector<GripperActuator>& actuators,
                    const MinimalGrippersOptions& options) {
  const RequiredRange range = required_range(requirement, options);
  const std::string fingers = std::to_string(requirement.fingers) + " fingers";
  if (!at_most(range.shortest, range.longest)) {
    const std::string required =
        requirement.max_finger_length < kInfinity
            ? "from " + exactly(requirement.min_finger_length) + " to " + exactly(requirement.max_finger_length)
            : "from " + exactly(requirement.min_finger_length);
    return "its fingers must be " + required +
           " long, not within shortest_finger = " + exactly(options.shortest_finger) +
           " and longest_finger = " + exactly(options.longest_finger) +
           (options.length_margin > 0 ? " with length_margin = " + exactly(options.length_margin) : "");
  }
  double widest = 0, longest_stroke = 0;
  bool has_fingers = false;
  for (const GripperActuator& a : actuators) {
    if (a.fingers != requirement.fingers) continue;
    has_fingers = true;
    if (!at_most(a.stroke, range.longest_stroke)) continue;
    widest = std::max(widest, a.max_opening);
    longest_stroke = std::max(longest_stroke, a.stroke);
  }
  if (!has_fingers) return "no actuator has " + fingers;
  if (widest == 0)
    return "actuators with " + fingers + " have strokes longer than its max_stroke = " + exactly(range.longest_stroke);
  if (!at_most(range.highest, widest))
    return "it is " + exactly(requirement.opening) + " wide" +
           (range.highest > requirement.opening ? " and asks for an opening of " + exactly(range.highest) : "") +
           ", actuators with " + fingers + " open to " + exactly(widest);
  RequiredRange closing = range;
  closing.least_closed = 0;
  const auto by_closing = [&](const auto& a) { return a.fingers == requirement.fingers && closing.can_be_met(a); };
  if (options.grid_openings == 0 && std::any_of(actuators.begin(), actuators.end(), by_closing))
    return "its gripper must not close below " + exactly(range.least_closed) + ", those that take it do";
  return options.grid_openings > 0 && at_most(range.highest - range.lowest, longest_stroke)
             ? "no gripper on the grid takes it: use a finer grid, or none"
             : "opening_margin = " + exactly(options.opening_margin) +
                   (2 * requirement.clearance > options.opening_margin
                        ? " and a clearance of " + exactly(requirement.clearance) + " leave"
                        : " leaves") +
                   " too little of the stroke";
}

/// An assembly with the candidate grippers for it: the cover of parts is chosen among these, checked, and explained.
class Problem {
 public:
  Problem(const std::vector<SegmentRequirement>& requirements, const std::vector<GripperActuator>& actuators,
          const MinimalGrippersOptions& options)
      : requirements_(requirements), actuators_(actuators), options_(options), parts_(named_parts(requirements)) {}

  MinimalGrippersResult solve(const Monitor& monitor) {
    const TimeLimit clock(options_.time_limit);
    MinimalGrippersResult result;
    result.parts = parts_.names;
    monitor.report("grippers to choose among", 0);
    auto found_candidates = gripper_candidates(requirements_, parts_.of_requirement, part_count(), actuators_, options_,
                                               [&] { return monitor.stopped() || clock.expired(); });
    if (!found_candidates) {
      result.outcome = monitor.stopped() ? Outcome::stopped : Outcome::timeout;
      return result;
    }
    candidates_ = std::move(*found_candidates);
    result.candidates = static_cast<int>(candidates_.size());
    explain_uncovered(result);
    if (!result.uncovered.empty()) {
      result.outcome = Outcome::infeasible;
      return result;
    }
    monitor.report("least set of grippers", 0);
    const SetCoverResult cover = solve_set_cover(set_cover_problem(), std::max(clock.seconds_left(), 1e-3), monitor);
    if (cover.chosen.empty()) {
      result.outcome = cover.outcome;
      return result;
    }
    monitor.report("fewest changes", 0.5);
    MinimalGrippersOptions rest = options_;
    rest.time_limit = std::max(clock.seconds_left(), 1e-3);
    const FewestChanges found =
        fewest_changes(candidates_, part_count(), cover.chosen, cover.lower_bound, rest, monitor);
    fill(found.best, result);
    result.changes_bound = found.proven ? result.changes : found.changes_bound;
    result.lower_bound = found.proven
                             ? result.cost
                             : std::min(result.cost, cover.lower_bound + options_.change_cost * found.changes_bound);
    const bool at_its_bounds =
        result.cost <= result.lower_bound * (1 + 1e-12) && result.changes == result.changes_bound;
    result.outcome = found.proven || at_its_bounds ? Outcome::solved
                     : monitor.stopped()           ? Outcome::stopped
                                                   : Outcome::approximate;
    return result;
  }

 private:
  int part_count() const { return parts_.count(); }

  void explain_uncovered(MinimalGrippersResult& result) const {
    Bits covered(part_count());
    for (const GripperCandidate& c : candidates_) covered |= c.parts;
    for (int p = 0; p < part_count(); ++p) {
      if (covered.test(p)) continue;
      CountedTexts why;
      for (std::size_t r = 0; r < requirements_.size(); ++r) {
        if (parts_.of_requirement[r] != p) continue;
        const std::string label =
            requirements_[r].segment.empty() ? "" : "segment '" + requirements_[r].segment + "': ";
        why.add(label + refusal(requirements_[r], actuators_, options_));
      }
      result.uncovered.push_back(parts_.names[p]);
      result.explanations.push_back("part '" + parts_.names[p] + "': " + why.joined());
    }
  }

  SetCoverProblem set_cover_problem() const {
    SetCoverProblem problem;
    problem.elements = part_count();
    for (const GripperCandidate& c : candidates_) {
      std::vector<int>& set = problem.sets.emplace_back();
      for (int p = c.parts.first(); p >= 0; p = c.parts.next(p + 1)) set.push_back(p);
      problem.costs.push_back(c.cost);
    }
    return problem;
  }

  /// The first requirement of a part that a candidate meets.
  int met_by(const GripperCandidate& candidate, int part) const {
    for (std::size_t r = 0; r < requirements_.size(); ++r) {
      if (parts_.of_requirement[r] == part &&
          meets(actuators_[candidate.actuator], candidate.min_opening, candidate.finger_length, requirements_[r],
                required_range(requirements_[r], options_)))
        return static_cast<int>(r);
    }
    throw std::logic_error("minimal_grippers: a part without its gripper");
  }

  void fill(const GripperChoice& choice, MinimalGrippersResult& result) const {
    std::vector<int> requirement_of_part;
    for (int p = 0; p < part_count(); ++p) requirement_of_part.push_back(met_by(candidates_[choice.of_part[p]], p));
    write_gripper_set({requirements_, actuators_, options_}, parts_.names, candidates_, choice.of_part,
                      requirement_of_part, result);
  }

  const std::vector<SegmentRequirement>& requirements_;
  const std::vector<GripperActuator>& actuators_;
  const MinimalGrippersOptions& options_;
  NamedParts parts_;
  std::vector<GripperCandidate> candidates_;
};

}  // namespace

void MinimalGrippersOptions::check() const {
  require_positive(shortest_finger, "shortest_finger", "m");
  require_number(longest_finger, "longest_finger", "m");
  require(longest_finger >= shortest_finger, "longest_finger", longest_finger,
          "must be a length of at least shortest_finger [m]");
  require_not_negative(opening_margin, "opening_margin", "m");
  require_not_negative(length_margin, "length_margin", "m");
  require_positive(finger_width, "finger_width", "m");
  require_positive(finger_thickness, "finger_thickness", "m");
  require_not_negative(change_cost, "change_cost", "", kLargestNumber);
  require(grid_openings >= 0 && grid_openings <= kMaxGrid, "grid_openings", grid_openings, "must be from 0 to 10000");
  require(grid_lengths >= 0 && grid_lengths <= kMaxGrid, "grid_lengths", grid_lengths, "must be from 0 to 10000");
  require((grid_openings == 0) == (grid_lengths == 0), "grid_lengths", grid_lengths,
          "must be 0 if and only if grid_openings is");
  require_count(max_nodes, "max_nodes");
  require(time_limit > 0, "time_limit", time_limit, "must be positive [s]");
}

MinimalGrippersResult minimal_grippers(const std::vector<SegmentRequirement>& requirements,
                                       const std::vector<GripperActuator>& actuators,
                                       const MinimalGrippersOptions& options, const Monitor& monitor) {
  options.check();
  if (requirements.empty()) throw InvalidInput("requirements is empty: name at least one segment");
  require(requirements.size() <= kMaxRequirements, "requirements", std::to_string(requirements.size()),
          "must be at most 100000");
  for (const SegmentRequirement& r : requirements) r.check();
  check_actuators(actuators);
  return Problem(requirements, actuators, options).solve(monitor);
}

}  // namespace mmgrasp
