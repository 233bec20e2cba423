#pragma once

#include <functional>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/robot/trajectory.hpp"

namespace mmgrasp::detail {

struct ShorteningOptions {
  int iterations = 200;
  double edge_step = 0.02;
  std::function<bool()> stopped = [] { return false; };
};

/// Shortens a free path and keeps it free at `edge_step`. First waypoints are skipped where a straight edge allows it;
/// then pairs of random points are joined, in all joints or in one joint alone (the others go on as before). Ends early
/// when nothing was gained for long.
void shorten_path(CollisionChecker& checker, JointPath& path, Rng& rng, const ShorteningOptions& options);

}  // namespace mmgrasp::detail
