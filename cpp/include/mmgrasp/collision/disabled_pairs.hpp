#pragma once

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/robot/robot.hpp"

namespace mmgrasp {

/// How many random configurations tell which pairs of links touch always or never (compute_disabled_pairs()): MoveIt's
/// setup assistant finds them in the same way.
struct MMGRASP_EXPORT DisabledPairsOptions {
  int samples = 10000;            ///< Random full configurations; > 0
  double always_fraction = 0.95;  ///< A pair in collision at least this often is called "always"; in (0, 1].
  unsigned seed = 1;
  int threads = 0;
  void check() const;
};

/// The robot with its disabled pairs computed from random samples: adjacent (joined by at most one movable joint with
/// no shape in between), always, never. Pairs that are disabled already (by an SRDF) are kept. The same seed gives the
/// same pairs at any thread count. Stopped early, only the adjacent ones are added.
MMGRASP_EXPORT Robot compute_disabled_pairs(const Robot& robot, const DisabledPairsOptions& options = {},
                                            const Monitor& monitor = {});

}  // namespace mmgrasp
