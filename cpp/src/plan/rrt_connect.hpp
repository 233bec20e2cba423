#pragma once

#include "plan/motion_edges.hpp"
#include "plan/planner_query.hpp"

namespace mmgrasp::detail {

/// RRT-Connect (Kuffner and LaValle 2000) with two changes: the smaller of the two trees is the one that draws, and a
/// path constraint projects each new configuration as CBiRRT does (Berenson et al. 2009). Reads the query's problem and
/// budget, not its functions except `stopped`; edges are looked at `finer` times as closely as the options say.
PlannerAnswer rrt_connect(MotionEdges& edges, const PlannerQuery& query, double finer);

}  // namespace mmgrasp::detail
