#pragma once

#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/geometry/segment_mesh.hpp"

namespace mmgrasp::detail {

/// Screw threads, found by their roots: sharp inward edges that run along a helix of at least two turns.
MMGRASP_EXPORT std::vector<ScrewThread> find_threads(const TriangleMesh& mesh);

/// Whether it is a bolt's, not a nut's.
inline bool is_external(const ScrewThread& thread) {
  return thread.crest_radius > thread.root_radius;
}

/// Moves the vertices of the thread's faces out to the radius of its crests. Others stay.
MMGRASP_EXPORT void smooth_thread(const ScrewThread& thread, TriangleMesh& mesh);

/// Outward normals of the cylinders that smoothed threads become, at their faces; zero at all others. Smoothing turns
/// the narrow faces of a noisy thread any way.
std::vector<Eigen::Vector3d> smoothed_normals(const TriangleMesh& mesh, const std::vector<ScrewThread>& threads);

}  // namespace mmgrasp::detail
