#pragma once

#include <Eigen/Core>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/core/monitor.hpp"
#include "mmgrasp/core/outcome.hpp"
#include "mmgrasp/optim/nonlinear_problem.hpp"

namespace mmgrasp {

/// min f(x) subject to lower <= x <= upper and c(x) <= 0, known by its values alone. Functions are called from the
/// thread that solves, with x inside the bounds. A value that is not finite means "undefined here" and is avoided.
struct MMGRASP_EXPORT DerivativeFreeProblem {
  Bounds bounds;  ///< Bounds of x; infinite where there is none, equal where a value is prescribed.
  std::function<double(const Eigen::VectorXd& x)> objective;
  /// c(x), always of length constraint_count; may be empty when that is 0.
  std::function<Eigen::VectorXd(const Eigen::VectorXd& x)> constraints;
  int constraint_count = 0;
};

/// When a search by values alone has converged, which violations it tolerates, and its budget.
struct MMGRASP_EXPORT DerivativeFreeOptions {
  /// Converged when steps fall below this share of a variable's range (of 1 where it is unbounded); in (0, 1).
  double tolerance = 1e-6;
  double constraint_tolerance = 1e-8;  ///< Largest c_i(x) that still counts as kept; >= 0.
  int max_evaluations = 10000;         ///< Budget: the functions are not called at more points than this; > 0.
  double time_limit = 30.0;            ///< Wall-clock cap [s]; > 0.
  unsigned seed = 1;                   ///< Same seed, same answer; without effect on solvers that draw nothing.
  void check() const;                  ///< Throws InvalidInput naming field, value and rule.
};

/// The best point that a search by values alone saw, and why it ended.
struct MMGRASP_EXPORT DerivativeFreeResult {
  /// solved: converged, constraints kept (a global solver proves nothing beyond that). timeout: the budget or the time
  /// limit ended it. stopped. not_found: converged where constraints are broken. approximate: rounding ended it early.
  Outcome outcome = Outcome::not_found;
  Eigen::VectorXd x;     ///< The best point seen: the least violated, then the cheapest. Inside the bounds.
  double value = 0;      ///< f(x); infinite when f was defined nowhere.
  double violation = 0;  ///< Largest c_i(x), or 0; infinite when f was defined nowhere.
  int evaluations = 0;   ///< Points at which the functions were called.
  double seconds = 0;
  std::string message;  ///< How the solver itself put it.
};

/// Search by values alone, for objectives without derivatives: simulations, counts, measured success.
///
///     DerivativeFreeProblem problem{{lower, upper}, [&](const Eigen::VectorXd& x) { return cost(x); }};
///     const auto result = minimize_derivative_free("bobyqa", problem, guess);
///
/// An exception thrown by a function ends the solve and reaches the caller. The cancel token and the time limit end it
/// at the next evaluation. Solvers may be called from several threads; those that draw random numbers wait for each
/// other, because NLopt has one generator.
class MMGRASP_EXPORT DerivativeFreeSolver {
 public:
  virtual ~DerivativeFreeSolver();
  virtual std::string name() const = 0;
  virtual bool is_global() const = 0;          ///< Searches the whole box, which must then be finite.
  virtual bool takes_constraints() const = 0;  ///< Problems with c(x) are refused by the others.
  /// Throws InvalidInput for a guess of the wrong length or not finite, bounds that contradict each other or are NaN,
  /// infinite bounds for a global solver, and constraints for one that takes none. The guess may lie outside the
  /// bounds: the nearest point inside is taken.
  DerivativeFreeResult solve(const DerivativeFreeProblem& problem, const Eigen::VectorXd& guess,
                             const DerivativeFreeOptions& options = {}, const Monitor& monitor = {}) const;

 private:
  virtual DerivativeFreeResult run(const DerivativeFreeProblem& problem, const Eigen::VectorXd& guess,
                                   const DerivativeFreeOptions& options, const Monitor& monitor) const = 0;
};

/// Local: "bobyqa" (quadratic models; Powell 2009; smooth objectives), "cobyla" (linear models, takes constraints;
/// Powell 1994), "nelder_mead" (simplex; 1965), "sbplx" (simplex on subspaces; Rowan 1990; noisy objectives, more
/// variables). Global: "crs2" (controlled random search; Kaelo and Ali 2006), "isres" (evolution, takes constraints;
/// Runarsson and Yao 2005), "direct_l" (dividing rectangles, draws nothing; Gablonsky and Kelley 2001), "esch"
/// (evolution; da Silva Santos 2010). All are NLopt's.
MMGRASP_EXPORT std::vector<std::string> derivative_free_solver_names();
/// Throws InvalidInput listing the known names on a wrong one.
MMGRASP_EXPORT std::unique_ptr<DerivativeFreeSolver> make_derivative_free_solver(const std::string& name);
/// Both steps in one: solve() of the solver of that name.
MMGRASP_EXPORT DerivativeFreeResult minimize_derivative_free(const std::string& solver,
                                                             const DerivativeFreeProblem& problem,
                                                             const Eigen::VectorXd& guess,
                                                             const DerivativeFreeOptions& options = {},
                                                             const Monitor& monitor = {});

}  // namespace mmgrasp
