#include "optim/nearest_kept.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace mmgrasp::detail {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kSteps = 8;
constexpr double kDamping = 1e-13;  // Of the largest entry: rows may repeat each other.
constexpr double kAtBound = 1e-4;   // Constraints this near to a bound are kept where they are.

VectorXd constraints_at(NonlinearProblem& problem, Eigen::Index count, const VectorXd& x) {
  VectorXd c(count);
  problem.constraints(x, c);
  return c;
}

/// How far each constraint is beyond its bounds.
VectorXd beyond(const Bounds& bounds, const VectorXd& c) {
  return c - c.cwiseMax(bounds.lower).cwiseMin(bounds.upper);
}

/// All rows; zero where the variable is at a bound.
MatrixXd movable_jacobian(NonlinearProblem& problem, const Bounds& variables, Eigen::Index rows, const VectorXd& x) {
  const SparsePattern& pattern = problem.jacobian_pattern();
  VectorXd values(static_cast<Eigen::Index>(pattern.size()));
  problem.jacobian(x, values);
  MatrixXd J = MatrixXd::Zero(rows, x.size());
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    const int k = pattern.columns[i];
    if (x[k] > variables.lower[k] && x[k] < variables.upper[k])
      J(pattern.rows[i], k) += values[static_cast<Eigen::Index>(i)];
  }
  return J;
}

/// One Newton step of least length on what is off, with the constraints nearer than `hold` to a bound kept there.
VectorXd stepped(NonlinearProblem& problem, const Bounds& variables, const Bounds& bounds, const VectorXd& at,
                 const VectorXd& c, const VectorXd& off, double hold) {
  MatrixXd J = movable_jacobian(problem, variables, off.size(), at);
  for (Eigen::Index i = 0; i < off.size(); ++i)
    if (off[i] == 0 && std::min(c[i] - bounds.lower[i], bounds.upper[i] - c[i]) >= hold) J.row(i).setZero();
  MatrixXd gram = J * J.transpose();
  gram.diagonal().array() += kDamping * gram.diagonal().maxCoeff();
  for (Eigen::Index i = 0; i < off.size(); ++i)
    if (J.row(i).isZero(0)) gram(i, i) = 1;
  return (at - J.transpose() * gram.ldlt().solve(off)).cwiseMax(variables.lower).cwiseMin(variables.upper);
}

}  // namespace

VectorXd nearest_kept(NonlinearProblem& problem, const VectorXd& x) {
  const Bounds variables = problem.variable_bounds(), bounds = problem.constraint_bounds();
  VectorXd at = x;
  if (bounds.lower.size() == 0) return at;
  VectorXd c = constraints_at(problem, bounds.lower.size(), at);
  VectorXd off = beyond(bounds, c);
  for (int step = 0; step < kSteps && off.lpNorm<Eigen::Infinity>() > 0; ++step) {
    const double before = off.lpNorm<Eigen::Infinity>();
    const VectorXd from = at, from_c = c, from_off = off;
    // Held ones may leave no room to move, free ones may be pushed beyond.
    for (const double hold : {kAtBound, 0.0}) {
      const VectorXd next = stepped(problem, variables, bounds, from, from_c, from_off, hold);
      const VectorXd next_c = constraints_at(problem, c.size(), next), next_off = beyond(bounds, next_c);
      if (!(next_off.lpNorm<Eigen::Infinity>() < off.lpNorm<Eigen::Infinity>())) continue;
      at = next;
      c = next_c;
      off = next_off;
    }
    if (off.lpNorm<Eigen::Infinity>() == before) break;
  }
  return at;
}

}  // namespace mmgrasp::detail
