#pragma once

#include <functional>

#include "mmgrasp/core/random.hpp"
#include "mmgrasp/robot/trajectory.hpp"
#include "plan/motion/motion_edges.hpp"

namespace mmgrasp::detail {

struct ShorteningOptions {
  int iterations = 200;
  double finer = 1;  ///< See MotionEdges.
  std::function<bool()> stopped = [] { return false; };
};

/// Shortens a free path and keeps it free at the edges' steps. First waypoints are skipped where a straight edge allows
/// it; then pairs of random points are joined, in all joints or in one joint alone (the others go on as before). Ends
/// early when nothing was gained for long.
void shorten_path(MotionEdges& edges, JointPath& path, Rng& rng, const ShorteningOptions& options);

}  // namespace mmgrasp::detail
