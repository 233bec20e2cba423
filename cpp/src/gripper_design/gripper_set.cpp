#include "gripper_design/gripper_set.hpp"

#include <algorithm>
#include <map>
#include <stdexcept>

#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {
namespace {

/// One gripper of a result: a candidate, fitted to the parts that it takes.
Gripper fitted(const GripperSetQuestion& question, const GripperCandidate& candidate, int index,
               const MinimalGrippersResult& result) {
  const GripperActuator& actuator = question.actuators[candidate.actuator];
  const MinimalGrippersOptions& options = question.options;
  Gripper gripper;
  gripper.name = "gripper_" + std::to_string(index + 1);
  gripper.actuator = actuator.name;
  gripper.fingers = actuator.fingers;
  gripper.min_opening = candidate.min_opening;
  gripper.finger_length = candidate.finger_length;
  gripper.finger_width = options.finger_width;
  gripper.finger_thickness = options.finger_thickness;
  if (options.grid_openings == 0) {
    double narrowest = kInfinity, widest = 0, lowest = kInfinity, highest = 0, least_closed = 0;
    gripper.finger_length = options.shortest_finger;
    for (std::size_t p = 0; p < result.gripper_of_part.size(); ++p) {
      if (result.gripper_of_part[p] != index) continue;
      const SegmentRequirement& r = question.requirements[result.requirement_of_part[p]];
      narrowest = std::min(narrowest, r.opening);
      widest = std::max(widest, r.opening);
      const RequiredRange range = required_range(r, options);
      lowest = std::min(lowest, range.lowest);
      highest = std::max(highest, range.highest);
      least_closed = std::max(least_closed, range.least_closed);
      gripper.finger_length = std::max(gripper.finger_length, range.shortest);
    }
    // Evenly about the parts, as far as the margins let it: these may differ below and above.
    double even = std::min(std::max((narrowest + widest - actuator.stroke) / 2, highest - actuator.stroke), lowest);
    if (least_closed > even) even = lowest;  // Pads are the wider the less centric fingers close.
    gripper.min_opening = std::max(0.0, std::min(even, actuator.max_opening - actuator.stroke));
  }
  gripper.max_opening = gripper.min_opening + actuator.stroke;
  return gripper;
}

void check_answer(const GripperSetQuestion& question, const MinimalGrippersResult& result) {
  for (std::size_t p = 0; p < result.parts.size(); ++p) {
    const SegmentRequirement& r = question.requirements[result.requirement_of_part[p]];
    const Gripper& g = result.grippers[result.gripper_of_part[p]];
    const MinimalGrippersOptions& options = question.options;
    const double above = std::max(options.opening_margin, 2 * r.clearance), length = options.length_margin;
    const bool kept = g.holds(r) && r.part == result.parts[p] && r.opening + above <= g.max_opening + 1e-8 &&
                      std::max(0.0, r.opening - options.opening_margin) >= g.min_opening - 1e-8 &&
                      r.min_finger_length + length <= g.finger_length + 1e-8 &&
                      g.finger_length <= r.max_finger_length - length + 1e-8;
    if (!kept) throw std::logic_error("minimal_grippers: '" + g.name + "' does not hold '" + r.name() + "'");
  }
}

}  // namespace

NamedParts named_parts(const std::vector<SegmentRequirement>& requirements) {
  NamedParts out;
  std::map<std::string, int> number;
  for (const SegmentRequirement& r : requirements) {
    const auto [place, is_new] = number.emplace(r.part, out.count());
    if (is_new) out.names.push_back(r.part);
    out.of_requirement.push_back(place->second);
  }
  return out;
}

void write_gripper_set(const GripperSetQuestion& question, const std::vector<std::string>& parts,
                       const std::vector<GripperCandidate>& candidates, const std::vector<int>& candidate_of_part,
                       const std::vector<int>& requirement_of_part, MinimalGrippersResult& result) {
  std::map<int, int> place;  // Candidate to its place in the result.
  std::vector<int> used;
  result.parts = parts;
  result.requirement_of_part = requirement_of_part;
  result.gripper_of_part.clear();
  result.grippers.clear();
  result.changes = 0;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const auto [at, is_new] = place.emplace(candidate_of_part[p], static_cast<int>(used.size()));
    if (is_new) used.push_back(candidate_of_part[p]);
    result.gripper_of_part.push_back(at->second);
    result.changes += p > 0 && result.gripper_of_part[p] != result.gripper_of_part[p - 1];
  }
  double gripper_cost = 0;
  for (std::size_t g = 0; g < used.size(); ++g) {
    gripper_cost += candidates[used[g]].cost;
    result.grippers.push_back(fitted(question, candidates[used[g]], static_cast<int>(g), result));
  }
  result.cost = gripper_cost + question.options.change_cost * result.changes;
  check_answer(question, result);
}

}  // namespace mmgrasp::detail
