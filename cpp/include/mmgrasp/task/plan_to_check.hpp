#pragma once

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/task/part_supply.hpp"
#include "mmgrasp/verify/plan_to_check.hpp"

namespace mmgrasp {

/// A plan and its problem as verify::check_plan() wants them: plain values, and the robot's URDFs as they were given.
/// What the plan claims (regions, discs, bounds, lengths, rates) goes along, so that it is judged too.
///
///     const verify::PlanCheckResult verdict = verify::check_plan(plan_to_check(problem, plan));
///     for (const verify::Fault& fault : verdict.faults) std::cout << fault.where << ": " << fault.message << "\n";
///
/// Throws InvalidInput for a plan that is none of this problem's (another number of trays or parts), and for a world
/// that the checker does not know (attached objects, distance fields).
MMGRASP_EXPORT verify::PlanToCheck plan_to_check(const PartSupplyProblem& problem, const PartSupplyPlan& plan);

}  // namespace mmgrasp
