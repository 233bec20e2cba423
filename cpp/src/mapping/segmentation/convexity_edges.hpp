#pragma once

#include "mapping/segmentation/greedy_multicut.hpp"
#include "mapping/segmentation/surface_patches.hpp"

namespace mmgrasp::detail {

/// One edge for each two patches that touch and have normals. Its weight is the number of pairs of cells along their
/// border times 1 where the surface is flat or bulges, 1 - angle / `concavity` in a crease, no less than -1. The angle
/// [rad] is that between the mean normals of the cells at the border, not of the whole patches: over the width of a
/// patch the inside of a cup turns as much as a crease does.
std::vector<SignedEdge> convexity_edges(const SurfaceCells& cells, const SurfacePatches& patches, double concavity);

}  // namespace mmgrasp::detail
