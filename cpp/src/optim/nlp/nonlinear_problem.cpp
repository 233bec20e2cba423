#include "mmgrasp/optim/nonlinear_problem.hpp"

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp {
namespace {

Eigen::VectorXd outside(const Eigen::VectorXd& x, const Bounds& bounds) {
  Eigen::VectorXd result(x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    result[i] =
        std::isfinite(x[i]) ? std::max({0.0, bounds.lower[i] - x[i], x[i] - bounds.upper[i]}) : detail::kInfinity;
  }
  return result;
}

}  // namespace

NonlinearProblem::~NonlinearProblem() = default;

std::string NonlinearProblem::variable_name(int index) const {
  return "x[" + std::to_string(index) + "]";
}

std::string NonlinearProblem::constraint_name(int index) const {
  return "c[" + std::to_string(index) + "]";
}

double NlpViolations::largest() const {
  double result = 0;
  if (variables.size() > 0) result = variables.maxCoeff();
  if (constraints.size() > 0) result = std::max(result, constraints.maxCoeff());
  return result;
}

NlpViolations violations(NonlinearProblem& problem, const Eigen::VectorXd& x) {
  NlpViolations result;
  result.variables = outside(x, problem.variable_bounds());
  const Bounds bounds = problem.constraint_bounds();
  Eigen::VectorXd c(bounds.lower.size());
  if (c.size() > 0) problem.constraints(x, c);
  result.constraints = outside(c, bounds);
  return result;
}

}  // namespace mmgrasp
