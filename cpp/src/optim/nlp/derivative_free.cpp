#include "mmgrasp/optim/derivative_free.hpp"

#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "optim/nlp/nlopt_search.hpp"

namespace mmgrasp {
namespace {

struct Entry {
  const char* name;
  std::unique_ptr<DerivativeFreeSolver> (*make)();
};
const Entry kSolvers[] = {
    {"bobyqa", &detail::make_bobyqa},     {"cobyla", &detail::make_cobyla}, {"nelder_mead", &detail::make_nelder_mead},
    {"sbplx", &detail::make_sbplx},       {"crs2", &detail::make_crs2},     {"isres", &detail::make_isres},
    {"direct_l", &detail::make_direct_l}, {"esch", &detail::make_esch}};

std::string comma_separated(const std::vector<std::string>& names) {
  std::string out;
  for (const std::string& name : names) out += (out.empty() ? "" : ", ") + name;
  return out;
}

std::string at(const char* field, Eigen::Index i) {
  return field + ("[" + std::to_string(i) + "]");
}

}  // namespace

DerivativeFreeSolver::~DerivativeFreeSolver() = default;

void DerivativeFreeOptions::check() const {
  require(tolerance > 0 && tolerance < 1, "tolerance", tolerance, "must be in (0, 1)");
  require_not_negative(constraint_tolerance, "constraint_tolerance", "", kLargestNumber);
  require_count(max_evaluations, "max_evaluations");
  require(time_limit > 0, "time_limit", time_limit, "must be positive");
}

DerivativeFreeResult DerivativeFreeSolver::solve(const DerivativeFreeProblem& problem, const Eigen::VectorXd& guess,
                                                 const DerivativeFreeOptions& options, const Monitor& monitor) const {
  options.check();
  const Bounds& bounds = problem.bounds;
  require(bounds.upper.size() == bounds.lower.size(), "bounds", static_cast<double>(bounds.upper.size()),
          "must have as many upper bounds as lower ones");
  require(guess.size() == bounds.lower.size(), "guess", static_cast<double>(guess.size()),
          "must have " + std::to_string(bounds.lower.size()) + " entries, one per variable");
  require(guess.size() > 0, "guess", 0.0, "must have at least one entry");
  for (Eigen::Index i = 0; i < guess.size(); ++i) {
    require_number(guess[i], at("guess", i), "", kLargestNumber);
    // Also refuses NaN.
    if (!(bounds.lower[i] <= bounds.upper[i]))
      require(false, at("bounds", i),
              "[" + std::to_string(bounds.lower[i]) + ", " + std::to_string(bounds.upper[i]) + "]",
              "the lower bound must not exceed the upper one");
    if (is_global() && !(std::isfinite(bounds.lower[i]) && std::isfinite(bounds.upper[i])))
      require(false, at("bounds", i), "infinite", name() + " searches the whole box, which must be finite");
  }
  require(static_cast<bool>(problem.objective), "objective", "empty", "must be a function");
  require(problem.constraint_count >= 0, "constraint_count", problem.constraint_count, "must be zero or positive");
  require(problem.constraint_count == 0 || problem.constraints, "constraints", "empty", "must be a function");
  if (problem.constraint_count > 0 && !takes_constraints()) {
    std::vector<std::string> able;
    for (const Entry& entry : kSolvers)
      if (entry.make()->takes_constraints()) able.emplace_back(entry.name);
    throw InvalidInput(name() + " takes no constraints; those that do: " + comma_separated(able));
  }
  return run(problem, guess.cwiseMax(bounds.lower).cwiseMin(bounds.upper), options, monitor);
}

std::vector<std::string> derivative_free_solver_names() {
  std::vector<std::string> names;
  for (const Entry& entry : kSolvers) names.emplace_back(entry.name);
  return names;
}

std::unique_ptr<DerivativeFreeSolver> make_derivative_free_solver(const std::string& name) {
  for (const Entry& entry : kSolvers)
    if (name == entry.name) return entry.make();
  throw InvalidInput("derivative-free solver = \"" + name + "\": must be one of " +
                     comma_separated(derivative_free_solver_names()));
}

DerivativeFreeResult minimize_derivative_free(const std::string& solver, const DerivativeFreeProblem& problem,
                                              const Eigen::VectorXd& guess, const DerivativeFreeOptions& options,
                                              const Monitor& monitor) {
  return make_derivative_free_solver(solver)->solve(problem, guess, options, monitor);
}

}  // namespace mmgrasp
