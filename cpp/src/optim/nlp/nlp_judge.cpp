// How a point is judged: objective and largest violation, found again without the solver.
#include <algorithm>

#include "optim/nlp/nlp_backends.hpp"

namespace mmgrasp::detail {

NlpResult judged(NonlinearProblem& problem, const Eigen::VectorXd& last, bool converged, bool budget_ended,
                 const BestIterate& best, const Eigen::VectorXd& guess, const NlpOptions& options,
                 const SolveClock& clock) {
  NlpResult result;
  const Bounds bounds = problem.variable_bounds();
  const auto take = [&](const Eigen::VectorXd& x) {
    // Interior points stand off the bounds by a relaxation of their own.
    result.x = x.cwiseMax(bounds.lower).cwiseMin(bounds.upper);
    result.objective = problem.objective(result.x);
    result.violated = violations(problem, result.x);
    return std::isfinite(result.objective) && result.violated.largest() <= options.constraint_tolerance;
  };
  const bool finite = last.size() == guess.size() && last.allFinite();
  if (converged && finite && take(last)) {
    result.outcome = Outcome::solved;
  } else {
    const bool keeps = take(best.any() ? best.x() : guess);
    result.outcome = clock.stopped()                ? Outcome::stopped
                     : clock.late() || budget_ended ? Outcome::timeout
                     : keeps                        ? Outcome::approximate
                                                    : Outcome::not_found;
  }
  result.seconds = clock.seconds();
  return result;
}

}  // namespace mmgrasp::detail
