#pragma once

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/robot/detail/whole_turns.hpp"
#include "plan/manipulation/common/grasp_candidates.hpp"

namespace mmgrasp::detail {

/// Adds whole turns of a grasp's starts and goals, as few as every path that costs less than `bound` needs: such a
/// path, shifted by whole turns of its joints, runs between two of the ends within limits (docs/methods/plan.md, "Whole
/// turns"). Where limits leave no choice that is proven to do, all turns are added. For each start and goal only the
/// nearest pairs of turns count, at most 64, and 8 when the bound is infinite; the nearest of all is always among them.
MMGRASP_EXPORT void add_turned_ends(const WholeTurns& turns, const JointGroup& group, double bound,
                                    GraspCandidate& candidate);

/// Adds the ends of another candidate of the same grasp that are not there.
void add_ends(const GraspCandidate& from, GraspCandidate& to);

}  // namespace mmgrasp::detail
