#pragma once

#include <functional>

#include "mmgrasp/task/pick.hpp"

namespace mmgrasp::detail {

/// The search behind plan_pick(), for a problem that is sound. Of the monitor only the cancel token is used: picks are
/// planned in parallel, and only the calling thread may report progress. `thorough`: grasps that failed are tried once
/// more with arm configurations that the database does not hold. `carries`: whether the base can drive to the place
/// with the object held by the grasp of this index; asked last, of a few grasps.
Pick search_pick(const PickProblem& problem, const ReachDatabase& database, const Monitor& monitor,
                 bool thorough = true, const std::function<bool(int)>& carries = {});

/// Where a pick failed whose object could be picked and placed, but not brought there.
inline constexpr char kHeldDriveStage[] = "drive";

}  // namespace mmgrasp::detail
