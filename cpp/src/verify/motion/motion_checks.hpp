#pragma once

#include <string>

#include "verify/context.hpp"

namespace mmgrasp::verify::detail {

// What motions of the arm alone and of base and arm are asked for.

constexpr double kMaxStep = 1e-6;  ///< Largest step where motions join [rad or m].
constexpr double kRest = 1e-3;     ///< Speed that counts as rest [rad/s or m/s].

/// Largest entry, whatever its sign.
inline double largest_of(const Eigen::VectorXd& values) {
  return values.cwiseAbs().maxCoeff();
}

/// "discontinuous". A controller takes the numbers as they stand, so a whole turn between them is a step, too.
inline void check_join(const Eigen::VectorXd& before, const Eigen::VectorXd& after, const std::string& where,
                       const std::string& what, Faults& faults) {
  const double by = largest_of(before - after);
  if (by > kMaxStep) faults.push_back({"discontinuous", where, what + ": a joint is off by " + text(by)});
}

/// "not-at-rest".
inline void check_rest(const Eigen::VectorXd& velocity, const std::string& where, const char* end, Faults& faults) {
  const double speed = largest_of(velocity);
  if (speed > kRest) faults.push_back({"not-at-rest", where, "moves at " + text(speed) + " at its " + end});
}

/// Configurations to look at along one motion.
class StepBudget {
 public:
  /// "too-long"; false when a fault was added.
  bool spend(double steps, const std::string& where, Faults& faults) {
    taken_ += steps;
    if (taken_ <= kMaxSteps) return true;  // false for NaN
    faults.push_back({"too-long", where, "travels farther than can be checked"});
    return false;
  }

 private:
  static constexpr double kMaxSteps = 200000;  // 2000 rad at the default step
  double taken_ = 0;
};

}  // namespace mmgrasp::verify::detail
