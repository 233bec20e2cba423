#pragma once

#include <optional>
#include <vector>

#include "mmgrasp/mapping/segment_objects.hpp"

namespace mmgrasp::detail {

/// Of the planes that RANSAC finds in the thinned points (always the same samples, then least squares), the largest
/// with most of the other points above it; nothing when none holds `min_plane_share` of the points. `eye` decides
/// which side is up when the other points do not.
std::optional<SupportingPlane> find_supporting_plane(const std::vector<Eigen::Vector3d>& points,
                                                     const ObjectSegmentationOptions& options,
                                                     const Eigen::Vector3d& eye);

/// Of points near a plane those that make its surface: walls, chairs and the like that cross it beside the table have
/// another direction, or are small pieces apart. `cell` [m] bridges gaps between points.
std::vector<Eigen::Vector3d> surface_of_plane(const std::vector<Eigen::Vector3d>& inliers, const SupportingPlane& plane,
                                              double cell);

}  // namespace mmgrasp::detail
