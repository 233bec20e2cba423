#pragma once

#include <optional>
#include <vector>

#include "gripper_design/gripper_candidates.hpp"

namespace mmgrasp::detail {

/// Grippers that take every part, and which one takes which part.
struct GripperChoice {
  std::vector<int> of_part;  ///< Candidate of each part, in the order of assembly.
  double gripper_cost = 0;   ///< Cost of the grippers used.
  int changes = 0;           ///< How often the gripper changes from part to part.
};

struct FewestChanges {
  GripperChoice best;
  int changes_bound = 0;  ///< No choice among all candidates needs fewer.
  bool proven = false;    ///< Nothing costs less, and nothing of the same cost needs fewer changes.
};

/// Branch and bound over sets of grippers: least cost of grippers and changes, then fewest changes. `known` covers
/// every part; `least_gripper_cost` is proven: no set that does costs less. Depends on the time limit and the monitor
/// only in when it ends early.
FewestChanges fewest_changes(const std::vector<GripperCandidate>& candidates, int part_count,
                             const std::vector<int>& known, double least_gripper_cost,
                             const MinimalGrippersOptions& options, const Monitor& monitor);

/// Prices by which a search bounds what it leaves out. Those of one search are a good beginning for another one among
/// the same candidates when these take a little less or more.
struct SearchPrices {
  std::vector<double> of_part;
  std::vector<double> of_use;  ///< One per candidate and part: candidate times the number of parts, and the part.
  double of_cost = 0;
  bool empty() const { return of_part.empty(); }
};

/// An answer to whether grippers cost no more and change no more often than others.
struct ChoiceAsGood {
  std::optional<GripperChoice> found;
  bool decided = false;  ///< Found, or proven that there is none.
  int nodes = 0;         ///< Looked at by the search.
};

/// The same search for any choice whose cost (of grippers and changes) and number of changes are no higher than those
/// of `limit`; it ends with the first one. Begins with `prices` unless they are empty, and leaves its own there.
ChoiceAsGood choice_as_good(const std::vector<GripperCandidate>& candidates, int part_count, const GripperChoice& limit,
                            double least_gripper_cost, const MinimalGrippersOptions& options, const Monitor& monitor,
                            SearchPrices& prices);

}  // namespace mmgrasp::detail
