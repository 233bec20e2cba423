#pragma once

#include <memory>
#include <string>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/geometry/mesh.hpp"

namespace mmgrasp::detail {

/// Turns the faces of an open mesh that enclose a negative volume with the middle of its bounds; true when it did. (The
/// loader turns closed ones.)
MMGRASP_EXPORT bool turn_outwards(TriangleMesh& mesh);

/// A copy with its faces turned outwards; the mesh itself when there is nothing to turn.
MMGRASP_EXPORT std::shared_ptr<const TriangleMesh> turned_outwards(const std::shared_ptr<const TriangleMesh>& mesh);

}  // namespace mmgrasp::detail
