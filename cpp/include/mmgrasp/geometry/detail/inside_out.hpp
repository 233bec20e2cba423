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

/// True when a file's triangles, as they are written there, enclose a negative volume: load_mesh() turns them where the
/// mesh is closed, and says nothing of it. Throws as load_mesh() does for files that cannot be read.
MMGRASP_EXPORT bool file_is_inside_out(const std::string& path);

}  // namespace mmgrasp::detail
