#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/optim/nonlinear_problem.hpp"
#include "mmgrasp/trajopt/optimize_whole_body.hpp"

namespace mmgrasp {

/// The nonlinear problem that optimize_whole_body() gives to a solver where nothing is in the way, and its guess: for
/// other solvers, and for costs and constraints of one's own.
///
///     const WholeBodyProgram program(problem, guess, WholeBodyOptions().smoothing);
///     const NlpResult found = make_nlp_solver("ipopt")->solve(*program.nonlinear(), program.guess());
///     const WholeBodyTrajectory motion = program.trajectory(found.x);
class MMGRASP_EXPORT WholeBodyProgram {
 public:
  /// Throws InvalidInput for what optimize_whole_body() refuses.
  WholeBodyProgram(const WholeBodyProblem& problem, const WholeBodyGuess& guess, double smoothing);

  const std::shared_ptr<NonlinearProblem>& nonlinear() const { return nonlinear_; }
  const Eigen::VectorXd& guess() const { return guess_; }

  /// Which variables are what: positions (waypoints x columns of the group), drive velocities (waypoints x drives, see
  /// drive_names), drive accelerations (intervals x drives), and the time step of each segment.
  Eigen::MatrixXi positions() const;
  Eigen::MatrixXi velocities() const;
  Eigen::MatrixXi accelerations() const;
  Eigen::VectorXi steps() const;

  WholeBodyTrajectory trajectory(const Eigen::VectorXd& x) const;
  /// What check_whole_body() says of it, constraints of one's own left out.
  std::vector<Violation> violations(const Eigen::VectorXd& x) const;

 private:
  const Eigen::VectorXd& checked(const Eigen::VectorXd& x) const;
  WholeBodyProblem problem_;
  std::shared_ptr<NonlinearProblem> nonlinear_;
  Eigen::VectorXd guess_;
};

}  // namespace mmgrasp
