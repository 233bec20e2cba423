#pragma once

#include <vector>

#include "geometry/segmentation/face_graph.hpp"

namespace mmgrasp::detail {

/// How far the surface bends inwards around each face, over a distance of `reach` [m] to every side [rad], from the
/// covariance of the normals and places of the faces there by area: the angle of two half discs that have it. A sharp
/// crease and a rounded one give the same as long as the rounding is narrower than the reach; noise cancels, and faces
/// without area, whose normals are chance, do not count.
std::vector<double> inward_bends(const FaceGraph& graph, double reach, int threads);

}  // namespace mmgrasp::detail
