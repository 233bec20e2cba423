#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "mmgrasp/core/export.hpp"

namespace mmgrasp {

/// Where the entries of a sparse matrix stand, in the order in which their values are written. Entries may repeat: they
/// add up.
struct MMGRASP_EXPORT SparsePattern {
  std::vector<int> rows, columns;
  std::size_t size() const { return rows.size(); }
  void add(int row, int column) {
    rows.push_back(row);
    columns.push_back(column);
  }
};

/// Box bounds; +-infinite where there is none, equal where a value is prescribed.
struct MMGRASP_EXPORT Bounds {
  Eigen::VectorXd lower, upper;
};

/// min f(x) subject to lower <= x <= upper and lower <= c(x) <= upper, twice differentiable. Derive from it, then:
///
///     Rosenbrock problem;
///     const NlpResult result = make_nlp_solver("ipopt")->solve(problem, x0);
///
/// Solvers call it from the thread they were called from, with x of the right length (finite or not); values that are
/// not finite are taken as "undefined here". Not thread-safe.
class MMGRASP_EXPORT NonlinearProblem {
 public:
  virtual ~NonlinearProblem();

  virtual Bounds variable_bounds() const = 0;
  virtual Bounds constraint_bounds() const = 0;  ///< Empty vectors: no constraints.

  virtual double objective(const Eigen::VectorXd& x) = 0;
  virtual void gradient(const Eigen::VectorXd& x, Eigen::Ref<Eigen::VectorXd> out) = 0;
  virtual void constraints(const Eigen::VectorXd& x, Eigen::Ref<Eigen::VectorXd> out) = 0;

  virtual const SparsePattern& jacobian_pattern() const = 0;
  virtual void jacobian(const Eigen::VectorXd& x, Eigen::Ref<Eigen::VectorXd> values) = 0;

  /// Lower triangle (row >= column) of factor * f'' + sum_i multipliers_i * c_i''.
  virtual const SparsePattern& hessian_pattern() const = 0;
  virtual void hessian(const Eigen::VectorXd& x, double factor, const Eigen::VectorXd& multipliers,
                       Eigen::Ref<Eigen::VectorXd> values) = 0;

  /// What to call a variable and a constraint in messages; by default x[i] and c[i].
  virtual std::string variable_name(int index) const;
  virtual std::string constraint_name(int index) const;
};

/// How far x is outside the bounds of variables and c(x) outside those of constraints; 0 where they hold.
struct MMGRASP_EXPORT NlpViolations {
  Eigen::VectorXd variables, constraints;
  double largest() const;  ///< Infinite when anything is not a number.
};
MMGRASP_EXPORT NlpViolations violations(NonlinearProblem& problem, const Eigen::VectorXd& x);

}  // namespace mmgrasp
