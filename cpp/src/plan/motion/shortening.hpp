#pragma once

#include <functional>

#include "mmgrasp/core/random.hpp"
#include "mmgrasp/robot/trajectory.hpp"
#include "plan/motion/motion_edges.hpp"

namespace mmgrasp::detail {

struct ShorteningOptions {
  int iterations = 200;
  double resolution = 1;  ///< Resolution factor of edge checks, as in MotionEdges.
  std::function<bool()> stopped = [] { return false; };
  bool skips_at_end = true;  ///< Skip waypoints once more; off for callers that remove redundant ones themselves.
};

/// Shortcuts a free path and keeps it free at the edges' steps. First waypoints are skipped where a straight edge is
/// free; then pairs of random points are joined, in all joints or in one joint alone (the others move as before). Ends
/// early when many shortcuts in a row gained nothing.
void shorten_path(MotionEdges& edges, JointPath& path, Rng& rng, const ShorteningOptions& options);

}  // namespace mmgrasp::detail
