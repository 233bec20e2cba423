#pragma once

#include <Eigen/Core>
#include <vector>

#include "mmgrasp/task/pick.hpp"

namespace mmgrasp::detail {

/// A part as an object of the scene, to be released over the bin, with the base standing there and these parts still in
/// place.
PickProblem pick_of(const PartSupplyProblem& problem, const Eigen::Vector3d& base_pose, PartRef ref,
                    const std::vector<PartRef>& remaining);

}  // namespace mmgrasp::detail
