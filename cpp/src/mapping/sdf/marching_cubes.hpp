#pragma once

// The triangles of a cell for each of the 256 sign patterns of its corners.

#include <array>
#include <vector>

namespace mmgrasp::detail {

/// Corner k of a cell lies at (k & 1, k >> 1 & 1, k >> 2). Edge 4 a + j runs along axis a from corner
/// kCellEdges[..][0].
extern const int kCellEdges[12][2];

/// Triples of edges for each pattern (bit k: corner k lies behind the surface); their crossings make triangles with
/// normals towards the front.
///
/// Made from the contours on the faces rather than typed in: on a face with two corners behind the surface across the
/// diagonal, these are cut off one by one, so that cells agree on their common face and the surface has no holes.
const std::array<std::vector<std::array<int, 3>>, 256>& marching_cubes_triangles();

}  // namespace mmgrasp::detail
