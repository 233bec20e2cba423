#pragma once

#include <vector>

#include "collision/checker/collision_search.hpp"
#include "collision/checker/edge_motion.hpp"
#include "collision/checker/pair_tests.hpp"
#include "collision/checker/placement.hpp"

namespace mmgrasp::detail {

/// The inner checks of a straight edge cut into equal pieces; both ends are known to be free. The answer is that of
/// testing every check. Far checks come first. At each check every body and pair that is open there is proven free as
/// far to both sides as its clearance there lasts; what is left open on either side is checked in its middle. Kept from
/// edge to edge for its memory alone.
class EdgeWalk {
 public:
  /// True when checks 1 .. pieces - 1 of the edge are all free.
  bool all_free(Placement& placement, CollisionSearch& search, const Eigen::VectorXd& q0, const Eigen::VectorXd& q1,
                long pieces);
  /// How many checks of the last edge were made or proven.
  std::size_t checks() const { return checks_; }

 private:
  /// A body or varying pair with the checks strictly between low and high, which are open.
  struct Open {
    int index, low, high;
    bool any() const { return high - low > 1; }
  };
  /// What is open on one side of a check.
  struct Interval {
    int at;                          ///< Where it is checked next.
    std::size_t bodies, pairs, end;  ///< Where its lists begin in open_, and end.
  };
  /// The same without proofs, one check after the other (see Stage).
  bool each_is_free();
  /// Places check `at`, unless it is placed.
  void place(int at);
  bool intervals_free();
  /// Places the interval's check; false when something open collides there. What stays open is in left_ and right_.
  bool check(const Interval& interval);
  bool bodies_free(const Interval& interval);
  bool pairs_free(const Interval& interval);
  /// Leaves an entry open but for the checks up to `proven` away from `at`.
  void keep(const Open& entry, int at, int proven);
  /// Queues what stays open on one side, bodies first, unless clearance tables prove all of it.
  void queue(const std::vector<Open>& side, std::size_t bodies);
  /// Whether the pair's clearance table proves all checks that are open.
  bool table_clears(const Open& pair) const;

  Placement* placement_ = nullptr;  ///< Bodies of the edge at hand.
  CollisionSearch* search_ = nullptr;
  Eigen::VectorXd q0_, delta_, piece_, q_;
  int pieces_ = 0, placed_ = 0;  ///< `placed_`: the check placed last.
  std::size_t checks_ = 0;
  EdgeMotion motion_;
  std::vector<Interval> queue_;     ///< Intervals that wait, and those that did.
  std::vector<Open> open_;          ///< Bodies and varying pairs of the waiting intervals.
  std::vector<Open> left_, right_;  ///< What the check at hand has open.
  std::vector<PairMemory> memory_;  ///< Per varying pair.
};

}  // namespace mmgrasp::detail
