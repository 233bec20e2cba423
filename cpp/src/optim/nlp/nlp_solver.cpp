#include "mmgrasp/optim/nlp_solver.hpp"

#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "optim/nlp/nlp_backends.hpp"

namespace mmgrasp {
namespace {

struct Entry {
  const char* name;
  std::unique_ptr<NlpSolver> (*make)();
};
const Entry kSolvers[] = {{"ipopt", &detail::make_ipopt}, {"slsqp", &detail::make_slsqp}};

void check_bounds(const Bounds& bounds, const char* field, const NonlinearProblem& problem, bool variables) {
  require(bounds.lower.size() == bounds.upper.size(), field, static_cast<double>(bounds.upper.size()),
          "must have as many upper bounds as lower ones");
  for (Eigen::Index i = 0; i < bounds.lower.size(); ++i) {
    // Also refuses NaN.
    if (bounds.lower[i] <= bounds.upper[i]) continue;
    const int at = static_cast<int>(i);
    require(false, std::string(field) + " of " + (variables ? problem.variable_name(at) : problem.constraint_name(at)),
            "[" + std::to_string(bounds.lower[i]) + ", " + std::to_string(bounds.upper[i]) + "]",
            "the lower bound must not exceed the upper one");
  }
}

void check_pattern(const SparsePattern& pattern, Eigen::Index rows, Eigen::Index columns, bool lower,
                   const char* field) {
  require(pattern.rows.size() == pattern.columns.size(), field, static_cast<double>(pattern.columns.size()),
          "must have as many columns as rows");
  for (std::size_t i = 0; i < pattern.rows.size(); ++i) {
    const int row = pattern.rows[i], column = pattern.columns[i];
    if (row >= 0 && row < rows && column >= 0 && column < columns && (!lower || row >= column)) continue;
    require(false, std::string(field) + "[" + std::to_string(i) + "]",
            "(" + std::to_string(row) + ", " + std::to_string(column) + ")",
            lower ? "must lie in the lower triangle" : "must lie in the matrix");
  }
}

}  // namespace

NlpSolver::~NlpSolver() = default;

void NlpOptions::check() const {
  require(tolerance > 0 && tolerance < 1, "tolerance", tolerance, "must be in (0, 1)");
  require_positive(constraint_tolerance, "constraint_tolerance", "", kLargestNumber);
  require_count(max_iterations, "max_iterations");
  require(time_limit > 0, "time_limit", time_limit, "must be positive");
  require_not_negative(barrier, "barrier");
  require_not_negative(warm_start, "warm_start");
}

NlpResult NlpSolver::solve(NonlinearProblem& problem, const Eigen::VectorXd& guess, const NlpOptions& options,
                           const Monitor& monitor) const {
  options.check();
  const Bounds variables = problem.variable_bounds(), constraints = problem.constraint_bounds();
  check_bounds(variables, "bounds", problem, true);
  check_bounds(constraints, "bounds", problem, false);
  const Eigen::Index n = variables.lower.size(), m = constraints.lower.size();
  require(guess.size() == n, "guess", static_cast<double>(guess.size()),
          "must have " + std::to_string(n) + " entries, one per variable");
  for (Eigen::Index i = 0; i < n; ++i) {
    if (std::isfinite(guess[i])) continue;
    require(false, "guess of " + problem.variable_name(static_cast<int>(i)), guess[i], "must be finite");
  }
  check_pattern(problem.jacobian_pattern(), m, n, false, "jacobian_pattern");
  check_pattern(problem.hessian_pattern(), n, n, true, "hessian_pattern");
  return run(problem, guess, options, monitor);
}

std::vector<std::string> nlp_solver_names() {
  std::vector<std::string> names;
  for (const Entry& entry : kSolvers) names.push_back(entry.name);
  return names;
}

std::unique_ptr<NlpSolver> make_nlp_solver(const std::string& name) {
  std::string known;
  for (const Entry& entry : kSolvers) {
    if (name == entry.name) return entry.make();
    known += std::string(known.empty() ? "" : ", ") + entry.name;
  }
  require(false, "solver", "'" + name + "'", "must be one of " + known);
  return nullptr;
}

NlpResult solve_nonlinear(const std::string& solver, NonlinearProblem& problem, const Eigen::VectorXd& guess,
                          const NlpOptions& options, const Monitor& monitor) {
  return make_nlp_solver(solver)->solve(problem, guess, options, monitor);
}

}  // namespace mmgrasp
