#pragma once

#include <algorithm>
#include <cmath>
#include <exception>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/detail/stopwatch.hpp"
#include "mmgrasp/optim/nlp_solver.hpp"

namespace mmgrasp::detail {

/// The best point seen: while none keeps the constraints, the least violated; after that the cheapest that keeps them.
class BestIterate {
 public:
  explicit BestIterate(double tolerance) : tolerance_(tolerance) {}
  /// True when it is now the best.
  bool offer(const Eigen::VectorXd& x, double objective, double violation) {
    if (!std::isfinite(objective) || !std::isfinite(violation) || !x.allFinite()) return false;
    const bool keeps = violation <= tolerance_, best_keeps = violation_ <= tolerance_;
    if (keeps != best_keeps ? !keeps : keeps ? objective >= objective_ : violation >= violation_) return false;
    x_ = x;
    objective_ = objective;
    violation_ = violation;
    return true;
  }
  bool any() const { return x_.size() > 0; }
  const Eigen::VectorXd& x() const { return x_; }

 private:
  double tolerance_, objective_ = 0, violation_ = kInfinity;
  Eigen::VectorXd x_;
};

/// When a solve has to end, and whether a callback wanted it to.
class SolveClock {
 public:
  SolveClock(double time_limit, const Monitor& monitor) : monitor_(monitor), limit_(time_limit) {}
  double seconds() const { return stopwatch_.seconds(); }
  bool stopped() const { return monitor_.stopped(); }
  bool late() const { return seconds() > limit_; }
  bool over() const { return stopped() || late() || error; }
  /// How far the iterations that are allowed have come.
  void report(int iteration, int most) const {
    monitor_.report("iterations", std::min(1.0, static_cast<double>(iteration) / std::max(1, most)));
  }
  /// Calls back unless the solve is over; false when it is, or when the callback throws, which ends the solve.
  template <typename Function>
  bool guarded(Function&& function) {
    if (over()) return false;
    try {
      return function();
    } catch (...) {
      error = std::current_exception();
      return false;
    }
  }
  std::exception_ptr error;  ///< Thrown by a callback.

 private:
  const Monitor& monitor_;
  Stopwatch stopwatch_;
  double limit_;
};

}  // namespace mmgrasp::detail
