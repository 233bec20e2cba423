#pragma once

#include "plan/motion/planner_query.hpp"

namespace mmgrasp::detail {

/// RRT-Connect (Kuffner and LaValle 2000) with two changes: the smaller of the two trees grows towards the sample, and
/// a path constraint projects each new configuration as CBiRRT does (Berenson et al. 2009). Reads the query's problem
/// and budget, and of its functions `edge_is_free`, `project` and `stopped`.
PlannerAnswer rrt_connect(const PlannerQuery& query);

}  // namespace mmgrasp::detail
