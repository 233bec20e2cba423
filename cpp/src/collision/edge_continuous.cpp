#include "collision/edge_continuous.hpp"

#include <algorithm>

namespace mmgrasp::detail {

EdgeResult advance_edge(CollisionChecker& checker, const Eigen::VectorXd& q0, const Eigen::VectorXd& q1,
                        const EdgeOptions& options) {
  const std::size_t before = checker.queries();
  // Two bodies of the robot may move towards each other.
  const double motion = 2 * motion_bounds(checker).cwiseProduct((q1 - q0).cwiseAbs()).sum();
  EdgeResult result;
  double fraction = 0;
  while (true) {
    const Eigen::VectorXd q = q0 + (q1 - q0) * fraction;
    const double gap = checker.distance(q).value;
    const bool refused = !checker.is_free(q);
    result.checks = static_cast<int>(checker.queries() - before);
    if (refused || gap < options.tolerance) {
      result.fraction = fraction;
      if (checker.rejection(q) == Rejection::limits) return result;
      result.contact = checker.first_contact(q);
      if (result.contact) return result;
      const DistanceResult near = checker.distance(q);
      result.contact = Contact{near.a, near.b, near.with_scene};
      return result;
    }
    if (fraction >= 1) break;
    // At least half the tolerance stays between the bodies on the way to the next look.
    fraction = motion > 0 ? std::min(1.0, fraction + (gap - 0.5 * options.tolerance) / motion) : 1.0;
  }
  result.free = true;
  return result;
}

}  // namespace mmgrasp::detail
