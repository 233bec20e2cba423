#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/core/outcome.hpp"
#include "mmgrasp/optim/nonlinear_problem.hpp"

namespace mmgrasp {

/// When an NlpSolver takes a point for optimal and feasible, its budget, and how Ipopt's barrier is lowered.
struct MMGRASP_EXPORT NlpOptions {
  double tolerance = 1e-7;             ///< Relative optimality, in (0, 1).
  double constraint_tolerance = 1e-8;  ///< Largest violation of a solved problem; > 0.
  int max_iterations = 500;            ///< > 0
  double time_limit = 30.0;            ///< Wall-clock cap [s]; > 0.
  double barrier = 0;  ///< Ipopt only: the first barrier parameter, lowered steadily; 0: chosen in each step.
  /// Ipopt only: 0 starts afresh; > 0 trusts the guess and starts with this barrier parameter.
  double warm_start = 0;
  void check() const;
};

/// Where an NlpSolver ended: the point, its objective, and by how much it breaks constraints.
struct MMGRASP_EXPORT NlpResult {
  /// solved: locally optimal and every constraint kept. approximate: every constraint kept, optimality not shown.
  /// not_found: the solver ended at a point that breaks constraints. timeout: iterations or clock. stopped.
  Outcome outcome = Outcome::not_found;
  Eigen::VectorXd x;       ///< The answer, or the best iterate: the least violated, then the cheapest. Always finite.
  double objective = 0;    ///< Its value at x.
  NlpViolations violated;  ///< Constraints that x breaks.
  int iterations = 0;      ///< Iterations of Ipopt, or evaluations of SLSQP.
  double seconds = 0;
  std::string message;  ///< How the solver itself put it.
};

/// Local solver of smooth problems. Callbacks that throw end the solve, and the exception reaches the caller; numbers
/// that are not finite never do harm. The cancel token ends it at the next evaluation.
///
///     const NlpResult found = make_nlp_solver("ipopt")->solve(problem, guess);
///     if (found.outcome == Outcome::solved) use(found.x);
class MMGRASP_EXPORT NlpSolver {
 public:
  virtual ~NlpSolver();
  virtual std::string name() const = 0;
  /// Throws InvalidInput for a guess of the wrong length or not finite, bounds that contradict each other or are NaN,
  /// and patterns outside the matrix. The guess may lie outside the bounds.
  NlpResult solve(NonlinearProblem& problem, const Eigen::VectorXd& guess, const NlpOptions& options = {},
                  const Monitor& monitor = {}) const;

 private:
  virtual NlpResult run(NonlinearProblem& problem, const Eigen::VectorXd& guess, const NlpOptions& options,
                        const Monitor& monitor) const = 0;
};

/// "ipopt": interior points on sparse matrices with exact Hessians; calls from several threads run side by side.
/// "slsqp": sequential least squares on dense matrices (NLopt's, as P1 4.2 used it), for a few hundred variables.
MMGRASP_EXPORT std::vector<std::string> nlp_solver_names();
/// Throws InvalidInput listing the known names on a wrong one.
MMGRASP_EXPORT std::unique_ptr<NlpSolver> make_nlp_solver(const std::string& name);

/// A local optimum near the guess by the solver of that name.
MMGRASP_EXPORT NlpResult solve_nonlinear(const std::string& solver, NonlinearProblem& problem,
                                         const Eigen::VectorXd& guess, const NlpOptions& options = {},
                                         const Monitor& monitor = {});

}  // namespace mmgrasp
