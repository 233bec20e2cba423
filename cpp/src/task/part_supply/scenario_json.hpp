#pragma once

#include <string>

#include "mmgrasp/task/plan_file.hpp"
#include "mmgrasp/verify/plan_to_check.hpp"

namespace mmgrasp::detail {

/// The section `scenario` of plan.json: what the problem alone decides.
std::string scenario_json(const PartSupplyProblem& problem, const ReachDatabase& database,
                          const verify::PlanToCheck& check, const PlanFileOptions& options);

/// The options that its database was built with, but for the number of threads.
std::string reach_json(const ReachDatabase& database);

}  // namespace mmgrasp::detail
