#pragma once

#include <string>
#include <vector>

#include "mmgrasp/task/ids.hpp"
#include "mmgrasp/task/problem.hpp"

namespace mmgrasp::detail {

/// Throws InvalidInput naming `name`, the base pose and what is wrong unless it lies in the base's workspace and the
/// robot at home is free there, with these parts in place.
void require_standing(const PartSupplyProblem& problem, const std::string& name, const Eigen::Vector3d& base_pose,
                      const std::vector<PartRef>& parts);

}  // namespace mmgrasp::detail
