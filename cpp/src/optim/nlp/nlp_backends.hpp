#pragma once

#include <memory>

#include "mmgrasp/optim/nlp_solver.hpp"
#include "optim/nlp/best_iterate.hpp"

namespace mmgrasp::detail {

std::unique_ptr<NlpSolver> make_ipopt();
std::unique_ptr<NlpSolver> make_slsqp();

/// Puts together what a backend found: x is the solver's last point when it claims to be done and that point is no
/// worse than it may be, else the best iterate; the outcome follows from what the point really breaks.
NlpResult judged(NonlinearProblem& problem, const Eigen::VectorXd& last, bool converged, bool budget_ended,
                 const BestIterate& best, const Eigen::VectorXd& guess, const NlpOptions& options,
                 const SolveClock& clock);

}  // namespace mmgrasp::detail
