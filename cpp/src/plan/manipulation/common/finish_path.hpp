#pragma once

#include "plan/manipulation/common/manipulation_planner.hpp"

namespace mmgrasp::detail {

/// Removes the waypoints of the result's path that it can do without: those whose neighbours are joined by an edge that
/// passes the final check. Reports the path when that made it cheaper.
void finish_path(const ManipulationInput& input, ManipulationResult& result);

}  // namespace mmgrasp::detail
