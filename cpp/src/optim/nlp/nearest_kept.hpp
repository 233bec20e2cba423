#pragma once

#include "mmgrasp/optim/nonlinear_problem.hpp"

namespace mmgrasp::detail {

/// A point near x that keeps the constraints better, by a few Newton steps of least length on those broken (dense),
/// while those at their bounds are held; x itself where they do not help. Variables at a bound stay there.
Eigen::VectorXd nearest_kept(NonlinearProblem& problem, const Eigen::VectorXd& x);

}  // namespace mmgrasp::detail
