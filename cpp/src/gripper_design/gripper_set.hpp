#pragma once

#include <string>
#include <vector>

#include "gripper_design/fewest_changes.hpp"
#include "gripper_design/gripper_candidates.hpp"

namespace mmgrasp::detail {

/// What a set of grippers is asked for.
struct GripperSetQuestion {
  const std::vector<SegmentRequirement>& requirements;
  const std::vector<GripperActuator>& actuators;
  const MinimalGrippersOptions& options;
};

/// The parts that requirements name, in the order of assembly, and the part of each requirement.
struct NamedParts {
  std::vector<std::string> names;
  std::vector<int> of_requirement;
  int count() const { return static_cast<int>(names.size()); }
};
NamedParts named_parts(const std::vector<SegmentRequirement>& requirements);

/// Writes a choice of candidates into a result: parts, grippers in the order of first use, cost, changes. Each gripper
/// has its stroke set evenly about what it takes, and fingers as short as that allows. Holds the answer against (5.2)
/// once more, part by part; a choice that breaks it is an error of the library.
void write_gripper_set(const GripperSetQuestion& question, const std::vector<std::string>& parts,
                       const std::vector<GripperCandidate>& candidates, const std::vector<int>& candidate_of_part,
                       const std::vector<int>& requirement_of_part, MinimalGrippersResult& result);

}  // namespace mmgrasp::detail
