#pragma once

#include <string>
#include <vector>

#include "plan/planner_query.hpp"

namespace mmgrasp::detail {

/// Throws IoError when the plugin cannot be opened, and whatever the query's functions threw.
PlannerAnswer solve_with_ompl(const PlannerQuery& query);

/// Names in the plugin's table. Throws IoError as above.
std::vector<std::string> ompl_planner_names();

}  // namespace mmgrasp::detail
