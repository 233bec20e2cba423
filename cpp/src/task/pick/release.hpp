#pragma once

#include <vector>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/reach/reach_database.hpp"
#include "mmgrasp/task/problem.hpp"

namespace mmgrasp::detail {

/// World poses of a part at which it hangs level over a region: turned about the vertical by any of several yaws, its
/// origin at several places inside the region's rectangle, its lowest point `drop_height` over it. The region's middle
/// comes first.
std::vector<Pose> places_over(const UnloadRegion& region, const Part& part);

/// The top of the bin on a robot as a region in the world.
UnloadRegion top_of_bin(const PlaceRegion& bin, const Pose& T_world_root);

/// Collision-free configurations that hold an object at some of these world poses, up to `count`, those nearest to
/// `from` first; `rejections` counts why others fell.
std::vector<Eigen::VectorXd> release_configurations(const ReachDatabase& database, CollisionChecker& holding,
                                                    const std::vector<Pose>& places, const Pose& T_hand_object,
                                                    const Eigen::VectorXd& from, std::size_t count,
                                                    Rejections& rejections);

}  // namespace mmgrasp::detail
