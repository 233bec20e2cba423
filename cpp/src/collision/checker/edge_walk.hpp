#pragma once

#include <vector>

#include "collision/checker/collision_search.hpp"
#include "collision/checker/edge_motion.hpp"
#include "collision/checker/pair_tests.hpp"
#include "collision/checker/placement.hpp"

namespace mmgrasp::detail {

/// The inner checks of a straight edge cut into equal pieces; both ends are known to be free. The answer is that of
/// testing every check. Intervals are halved, far checks first; in the middle of an interval every body whose sphere
/// stays farther from all others than it can move up to the interval's ends is proven free in all of it and not tested
/// there again.
class EdgeWalk {
 public:
  EdgeWalk(Placement& placement, CollisionSearch& search, const Eigen::VectorXd& q0, const Eigen::VectorXd& q1,
           long pieces);

  /// True when checks 1 .. pieces - 1 are all free.
  bool all_free();
  /// How many checks were made or proven.
  std::size_t checks() const { return checks_; }

 private:
  struct Interval {
    long low, high;                  ///< Checks strictly between are open.
    std::size_t bodies, pairs, end;  ///< Where its lists begin in open_, and end.
  };
  /// The same without proofs, one check after the other (see Stage).
  bool each_is_free();
  /// Places check `at`; false when something open collides there. What may collide within `reach` pieces of it is
  /// appended to open_.
  bool check(const Interval& interval, long at, double reach, Interval& rest);
  bool bodies_free(const Interval& interval, double reach);
  bool pairs_free(const Interval& interval, double reach);

  Placement& placement_;
  CollisionSearch& search_;
  Eigen::VectorXd q0_, delta_, q_;
  long pieces_;
  std::size_t checks_ = 0;
  EdgeMotion motion_;
  std::vector<int> open_;           ///< Bodies and varying pairs of the waiting intervals.
  std::vector<PairMemory> memory_;  ///< Per varying pair.
};

}  // namespace mmgrasp::detail
