#pragma once

#include <vector>

#include "geometry/segmentation/face_graph.hpp"

namespace mmgrasp::detail {

/// Joins neighbouring regions of faces (label < 0: in none). First those narrower than `narrowest` [m] with the
/// neighbour that they stand out from least; then all whose hull has little that belongs to neither: at most
/// `convexity` times the smaller one's volume, or nearly all of both lies on it. Hulls are those of the faces that are
/// `outer`, no inner walls, where a region has any. Renumbers the labels from 0; returns how many there are.
int join_regions(const FaceGraph& graph, const std::vector<char>& outer, double narrowest, double convexity,
                 std::vector<int>& labels);

}  // namespace mmgrasp::detail
