#pragma once

#include <string>
#include <vector>

#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/reach/reach_database.hpp"
#include "mmgrasp/task/ids.hpp"
#include "mmgrasp/task/problem.hpp"

namespace mmgrasp::detail {

/// What would let a pick be planned that failed, found by planning it again with one thing changed at a time: without
/// each of the nearest obstacles, without the parts around it, hardly lifted, hardly approached, not released. Of
/// `known` remedies only these are tried; empty: all. Empty when none of them alone helps.
std::vector<std::string> pick_remedies(const PartSupplyProblem& problem, const ReachDatabase& database,
                                       const Eigen::Vector3d& base_pose, PartRef part,
                                       const std::vector<PartRef>& remaining, const std::vector<std::string>& known,
                                       const Monitor& monitor);

}  // namespace mmgrasp::detail
