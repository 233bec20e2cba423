#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "mmgrasp/task/pick.hpp"

namespace mmgrasp::detail {

/// A part as an object of the scene, to be released over the bin or at the goal, with the base standing there and these
/// parts still in place.
PickProblem pick_of(const PartSupplyProblem& problem, const Eigen::Vector3d& base_pose, PartRef ref,
                    const std::vector<PartRef>& remaining);

/// Whether the base can drive from this pose to the goal with the part in the hand, by its grasp of this index, these
/// parts still in place. Asked from many threads at once.
using HeldDrive = std::function<bool(const Eigen::Vector3d& base_pose, PartRef part, int grasp,
                                     const std::vector<PartRef>& remaining)>;

/// plan_pick() without its checks; with a drive, grasps that it refuses are left.
Pick pick_part(const PartSupplyProblem& problem, const ReachDatabase& database, const Eigen::Vector3d& base_pose,
               PartRef part, const std::vector<PartRef>& remaining, const Monitor& monitor,
               const HeldDrive& drive = {});

}  // namespace mmgrasp::detail
