#pragma once

#include <optional>
#include <vector>

#include "mapping/segmentation/surface_cells.hpp"
#include "mmgrasp/mapping/segment_objects.hpp"

namespace mmgrasp::detail {

/// The largest of the planes that RANSAC finds in the cells (always the same samples, then least squares) that has most
/// of the other planes above it; nothing when none holds `min_plane_share` of the cells. Above is where `options.up`
/// points, else away from the solid: as the cells' normals say, without normals to the side of `eye`. So the top of a
/// large box is no supporting plane.
std::optional<SupportingPlane> find_supporting_plane(const SurfaceCells& cells,
                                                     const ObjectSegmentationOptions& options,
                                                     const Eigen::Vector3d& eye);

/// Those points near a plane that make its surface: walls, chairs and the like that cross it beside the table have
/// another direction, or are small pieces apart. `cell` [m] bridges gaps between points.
std::vector<Eigen::Vector3d> surface_of_plane(const std::vector<Eigen::Vector3d>& inliers, const SupportingPlane& plane,
                                              double cell);

}  // namespace mmgrasp::detail
