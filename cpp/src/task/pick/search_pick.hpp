#pragma once

#include "mmgrasp/task/pick.hpp"

namespace mmgrasp::detail {

/// The search behind plan_pick(), for a problem that is sound. Of the monitor only the cancel token is used: picks are
/// planned in parallel, and only the calling thread may report progress. `thorough`: grasps that failed are tried once
/// more with arm configurations that the database does not hold.
Pick search_pick(const PickProblem& problem, const ReachDatabase& database, const Monitor& monitor,
                 bool thorough = true);

}  // namespace mmgrasp::detail
