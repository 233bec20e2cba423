#pragma once

#include <vector>

#include "mmgrasp/collision/checker.hpp"
#include "task/problem/scene.hpp"

namespace mmgrasp {

/// Tool poses at which the part hangs level over the bin: turned about the vertical by any of several yaws, its origin
/// at several places inside the bin's rectangle, its lowest point `drop_gap` over the bin's top. The bin's middle comes
/// first.
std::vector<Pose> release_poses(const PartSupplyProblem& problem, const Pose& T_world_root, const Part& part,
                                const Pose& T_tcp_part);

/// Collision-free configurations for some of these poses, those nearest to `from` first; `stages` counts what fell
/// where.
std::vector<Eigen::VectorXd> release_configurations(const ReachDatabase& database, CollisionChecker& holding,
                                                    const std::vector<Pose>& poses, const Eigen::VectorXd& from,
                                                    std::size_t count, Rejections& rejections);

}  // namespace mmgrasp
