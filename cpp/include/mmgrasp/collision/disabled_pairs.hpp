#pragma once

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/robot/robot.hpp"

namespace mmgrasp {

struct MMGRASP_EXPORT DisabledPairsOptions {
  int samples = 10000;           ///< Random full configurations; > 0
  double always_fraction = 0.95; ///< A pair in collision at least this often is called "always"; in (0, 1].
  unsigned seed = 1;
  int threads = 0;
  void check() const;
};

/// The robot with its disabled pairs computed from random samples: adjacent (joined by a joint), always, never. Pairs that
/// were set by an SRDF are kept.
MMGRASP_EXPORT Robot compute_disabled_pairs(const Robot& robot, const DisabledPairsOptions& options = {},
                                            const Monitor& monitor = {});

}  // namespace mmgrasp
