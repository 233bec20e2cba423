#pragma once

#include <vector>

#include "geometry/segmentation/face_graph.hpp"

namespace mmgrasp::detail {

/// How far the surface bends inwards around each face, over a distance of `reach` [m] to every side [rad]: the largest
/// eigenvalue, its sign turned, of the mean curvature tensor of the edges there (Cohen-Steiner and Morvan 2003), times
/// the width. A sharp crease and a rounded one of the same angle give the same as long as the rounding is narrower than
/// the reach; what noise bends to and fro cancels.
std::vector<double> inward_bends(const FaceGraph& graph, double reach, int threads);

}  // namespace mmgrasp::detail
