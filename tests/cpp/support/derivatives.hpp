#pragma once

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <string>

#include "mmgrasp/optim/nonlinear_problem.hpp"

namespace mmgrasp::test {

inline Eigen::MatrixXd dense(const SparsePattern& pattern, const Eigen::VectorXd& values, Eigen::Index rows,
                             Eigen::Index columns, bool symmetric) {
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(rows, columns);
  for (std::size_t i = 0; i < pattern.size(); ++i) {
    const int r = pattern.rows[i], c = pattern.columns[i];
    M(r, c) += values[static_cast<Eigen::Index>(i)];
    if (symmetric && r != c) M(c, r) += values[static_cast<Eigen::Index>(i)];
  }
  return M;
}

/// Gradient, Jacobian and Hessian of the Lagrangian against central differences of the function one order below, each
/// entry within 1e-6 relative to the larger of 1 and the largest entry of its row.
inline void expect_exact_derivatives(NonlinearProblem& problem, const Eigen::VectorXd& x, double factor,
                                     const Eigen::VectorXd& multipliers, double step = 1e-5) {
  const Eigen::Index n = x.size(), m = multipliers.size();
  const auto jacobian = [&](const Eigen::VectorXd& at) {
    Eigen::VectorXd values(static_cast<Eigen::Index>(problem.jacobian_pattern().size()));
    problem.jacobian(at, values);
    return dense(problem.jacobian_pattern(), values, m, n, false);
  };
  const auto lagrangian_gradient = [&](const Eigen::VectorXd& at) {
    Eigen::VectorXd g(n);
    problem.gradient(at, g);
    return Eigen::VectorXd(factor * g + jacobian(at).transpose() * multipliers);
  };
  Eigen::VectorXd g(n), hessian_values(static_cast<Eigen::Index>(problem.hessian_pattern().size()));
  problem.gradient(x, g);
  problem.hessian(x, factor, multipliers, hessian_values);
  const Eigen::MatrixXd J = jacobian(x), H = dense(problem.hessian_pattern(), hessian_values, n, n, true);
  Eigen::VectorXd numeric_g(n);
  Eigen::MatrixXd numeric_J(m, n), numeric_H(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    Eigen::VectorXd low = x, high = x, c_low(m), c_high(m);
    low[i] -= step;
    high[i] += step;
    problem.constraints(low, c_low);
    problem.constraints(high, c_high);
    numeric_g[i] = (problem.objective(high) - problem.objective(low)) / (2 * step);
    numeric_J.col(i) = (c_high - c_low) / (2 * step);
    numeric_H.col(i) = (lagrangian_gradient(high) - lagrangian_gradient(low)) / (2 * step);
  }
  const auto compare = [&](const Eigen::MatrixXd& exact, const Eigen::MatrixXd& numeric, const std::string& what,
                           bool rows_are_constraints) {
    for (Eigen::Index r = 0; r < exact.rows(); ++r) {
      const double scale = std::max(1.0, exact.row(r).cwiseAbs().maxCoeff());
      Eigen::Index c = 0;
      const double worst = (exact.row(r) - numeric.row(r)).cwiseAbs().maxCoeff(&c);
      EXPECT_LE(worst, 1e-6 * scale) << what << " of "
                                     << (rows_are_constraints ? problem.constraint_name(static_cast<int>(r))
                                                              : problem.variable_name(static_cast<int>(r)))
                                     << " by " << problem.variable_name(static_cast<int>(c)) << ": " << exact(r, c)
                                     << " against " << numeric(r, c);
    }
  };
  compare(g.transpose(), numeric_g.transpose(), "gradient", false);
  compare(J, numeric_J, "Jacobian", true);
  compare(H, numeric_H, "Hessian", false);
}

}  // namespace mmgrasp::test
