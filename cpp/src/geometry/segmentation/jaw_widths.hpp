#pragma once

#include <vector>

#include "geometry/segmentation/jaw_reach.hpp"
#include "mmgrasp/geometry/fit_primitives.hpp"

namespace mmgrasp::detail {

/// The widths at which parallel jaws may close on a segment that a box stands for: those of its opposite facets, most
/// covered first, as far as fingers reach them. Pairs along one axis that are as far apart, within what their faces are
/// rough, are one width.
std::vector<GraspWidth> jaw_widths(const TriangleMesh& mesh, const std::vector<int>& faces, const FittedPrimitive& box,
                                   double min_contact, JawReach& reach);

}  // namespace mmgrasp::detail
