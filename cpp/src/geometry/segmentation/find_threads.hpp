#pragma once

#include <vector>

#include "mmgrasp/geometry/segment_mesh.hpp"

namespace mmgrasp::detail {

/// Screw threads, found by their roots: sharp inward edges that run along a helix of at least two turns.
std::vector<ScrewThread> find_threads(const TriangleMesh& mesh);

/// Moves the vertices of the thread's faces out to the radius of its crests. Others stay.
void smooth_thread(const ScrewThread& thread, TriangleMesh& mesh);

}  // namespace mmgrasp::detail
