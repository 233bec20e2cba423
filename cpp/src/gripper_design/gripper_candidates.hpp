#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "mmgrasp/core/detail/bits.hpp"
#include "mmgrasp/gripper_design/minimal_grippers.hpp"

namespace mmgrasp::detail {

/// Throws InvalidInput: no actuator, names missing or there twice, numbers out of range.
void check_actuators(const std::vector<GripperActuator>& actuators);

/// What a requirement leaves of opening and finger length once margins and clearance are taken off.
struct RequiredRange {
  double lowest = 0, highest = 0;    ///< Both openings lie within the gripper's [m].
  double least_closed = 0;           ///< The gripper's smallest opening is no less [m].
  double longest_stroke = 0;         ///< The drive's stroke is no more [m].
  double shortest = 0, longest = 0;  ///< The finger's length lies between them [m].
  bool can_be_met(const GripperActuator& actuator) const;
};
RequiredRange required_range(const SegmentRequirement& requirement, const MinimalGrippersOptions& options);

/// A gripper worth choosing, and the parts (by their number) that it takes.
struct GripperCandidate {
  int actuator = 0;
  double min_opening = 0;
  double finger_length = 0;
  double cost = 1;
  Bits parts;
};

/// Whether a gripper meets a requirement; lengths within 1e-9 m count as equal.
bool meets(const GripperActuator& actuator, double min_opening, double finger_length,
           const SegmentRequirement& requirement, const RequiredRange& range);

/// Tells that work must end: a clock or a caller says so. Once true it stays true.
using Ended = std::function<bool()>;

/// Every gripper that matters, or those on P1's grid, without those that take no more than another one of no higher
/// cost; none when it was ended first. `part_of` numbers the requirements' parts.
std::optional<std::vector<GripperCandidate>> gripper_candidates(const std::vector<SegmentRequirement>& requirements,
                                                                const std::vector<int>& part_of, int part_count,
                                                                const std::vector<GripperActuator>& actuators,
                                                                const MinimalGrippersOptions& options,
                                                                const Ended& ended);

}  // namespace mmgrasp::detail
