#pragma once

#include <string>
#include <vector>

#include "plan/motion/planner_query.hpp"

namespace mmgrasp::detail {

/// Throws IoError when the plugin cannot be opened, and whatever the query's functions threw.
PlannerAnswer solve_with_ompl(const PlannerQuery& query);

/// A planner of the plugin's table.
struct OmplPlanner {
  std::string name;
  bool keeps_improving;  ///< Goes on after its first path until its budget is spent.
};
/// The plugin's table. Throws IoError as above.
std::vector<OmplPlanner> ompl_planners();

}  // namespace mmgrasp::detail
