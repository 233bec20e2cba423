#pragma once

#include "mmgrasp/geometry/mesh.hpp"

namespace mmgrasp::detail {

/// Turns the faces of an open mesh that enclose a negative volume with the middle of its bounds; true when it did. (The
/// loader turns closed ones.)
bool turn_outwards(TriangleMesh& mesh);

}  // namespace mmgrasp::detail
