#pragma once

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/robot/robot.hpp"

namespace mmgrasp {

/// How pairs of links are found that need no collision check (compute_disabled_pairs()).
struct MMGRASP_EXPORT DisabledPairsOptions {
  int samples = 10000;            ///< Random full configurations; > 0
  double always_fraction = 0.95;  ///< A pair in collision at least this often is called "always"; in (0, 1].
  /// Pairs that touch in no sample are "never" without a proof, as MoveIt's setup assistant has them: some of them
  /// do touch, in configurations that no sample met.
  bool trust_samples = false;
  unsigned seed = 1;
  int threads = 0;
  void check() const;
};

/// The robot with its disabled pairs computed: adjacent (joined by at most one movable joint with no shape in between),
/// always (from random samples), never (proven over all values of the joints in between, see docs/methods/collision.md;
/// pairs that many joints part mostly have no such proof and stay enabled). Pairs that are disabled already (by an
/// SRDF) are kept. The same seed gives the same pairs at any thread count. Stopped early, only the adjacent ones are
/// added.
MMGRASP_EXPORT Robot compute_disabled_pairs(const Robot& robot, const DisabledPairsOptions& options = {},
                                            const Monitor& monitor = {});

}  // namespace mmgrasp
