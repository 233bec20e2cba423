#pragma once

#include <vector>

#include "geometry/segmentation/face_graph.hpp"

namespace mmgrasp::detail {

/// Faces that look at the solid itself: walls of holes and bores, sides of grooves. A ray from their middle along the
/// outward normal meets the surface again.
struct InnerWalls {
  std::vector<char> inner;    ///< One a face.
  std::vector<int> opposite;  ///< The face where the ray into the solid leaves it again; -1: none.
};

InnerWalls find_inner_walls(const FaceGraph& graph, int threads);

/// Gives inner faces the label of the region on the other side of their wall, with borders that are short; those
/// without one take part as the others do.
void label_inner_walls(const FaceGraph& graph, const InnerWalls& walls, int count, std::vector<int>& labels);

}  // namespace mmgrasp::detail
