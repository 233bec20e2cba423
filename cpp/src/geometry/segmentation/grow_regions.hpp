#pragma once

#include <vector>

#include "geometry/segmentation/face_graph.hpp"

namespace mmgrasp::detail {

/// Regions of faces that are `open`, joined over edges that `passable` lets through; those smaller than `least_area`
/// [m^2] stay without a label (-1), unless no region were left.
std::vector<int> connected_regions(const FaceGraph& graph, const std::vector<char>& open,
                                   const std::vector<char>& passable, double least_area);

/// Lets regions grow over the `open` faces without a label, edge by edge: flat and outward edges first, inward ones
/// from the least bend up, so that regions meet in the creases.
void grow_regions(const FaceGraph& graph, const std::vector<char>& open, std::vector<int>& labels);

/// Gives pieces of a region that lie apart and are smaller than `least_area` [m^2] to the regions around them.
void dissolve_islands(const FaceGraph& graph, double least_area, std::vector<int>& labels);

}  // namespace mmgrasp::detail
