#pragma once

#include <vector>

#include "collision/checker/checker_impl.hpp"

namespace mmgrasp {

namespace detail {

/// No edge is cut into more pieces.
constexpr double kMaxPieces = 1e9;

}  // namespace detail

/// The inner checks of a straight edge cut into equal pieces; both ends are known to be within limits. The answer is
/// that of looking at every check. Intervals are halved, far checks first; in the middle of an interval every body
/// whose balls stay farther from all others than it can move up to the interval's ends is proven free in all of it and
/// not looked at there again.
class CollisionChecker::Impl::EdgeWalk {
 public:
  EdgeWalk(Impl& checker, const Eigen::VectorXd& q0, const Eigen::VectorXd& q1, long pieces);

  /// True when checks 1 .. pieces - 1 are all free.
  bool all_free();

 private:
  struct Interval {
    long low, high;                  ///< Checks strictly between are open.
    std::size_t bodies, pairs, end;  ///< Where its lists begin in open_, and end.
  };
  /// Places check `at`; false when something open collides there. What may collide within `reach` pieces of it is
  /// appended to open_.
  bool look(const Interval& interval, long at, double reach, Interval& rest);
  bool bodies_free(const Interval& interval, double reach);
  bool pairs_free(const Interval& interval, double reach);

  Impl& checker_;
  Eigen::VectorXd q0_, delta_, q_;
  long pieces_;
  Eigen::VectorXd body_motion_, pair_motion_;  ///< Per piece [m].
  std::vector<int> open_;
  std::vector<char> hulls_meet_;  ///< Per varying pair; see pair_within.
};

}  // namespace mmgrasp
