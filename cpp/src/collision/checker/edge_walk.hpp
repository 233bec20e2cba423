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
/// there again. Kept from edge to edge for its memory alone.
class EdgeWalk {
 public:
  /// True when checks 1 .. pieces - 1 of the edge are all free.
  bool all_free(Placement& placement, CollisionSearch& search, const Eigen::VectorXd& q0, const Eigen::VectorXd& q1,
                long pieces);
  /// How many checks of the last edge were made or proven.
  std::size_t checks() const { return checks_; }

 private:
  struct Interval {
    long low, high;                  ///< Checks strictly between are open.
    std::size_t bodies, pairs, end;  ///< Where its lists begin in open_, and end.
  };
  /// The same without proofs, one check after the other (see Stage).
  bool each_is_free();
  /// Places check `at`, unless it is placed.
  void place(long at);
  bool intervals_free();
  /// Places check `at`; false when something open collides there. What may collide within `reach` pieces of it is
  /// appended to open_.
  bool check(const Interval& interval, long at, double reach, Interval& rest);
  bool bodies_free(const Interval& interval, double reach);
  /// Whether nothing but pairs with clearance tables is open in an interval, and these prove all of its checks.
  bool tables_clear(const Interval& interval) const;
  bool pairs_free(const Interval& interval, double reach);

  Placement* placement_ = nullptr;  ///< Bodies of the edge at hand.
  CollisionSearch* search_ = nullptr;
  Eigen::VectorXd q0_, delta_, piece_, q_;
  long pieces_ = 0, placed_ = 0;  ///< `placed_`: the check placed last.
  std::size_t checks_ = 0;
  EdgeMotion motion_;
  std::vector<Interval> queue_;     ///< Intervals that wait, and those that did.
  std::vector<int> open_;           ///< Bodies and varying pairs of the waiting intervals.
  std::vector<PairMemory> memory_;  ///< Per varying pair.
};

}  // namespace mmgrasp::detail
