#include "mmgrasp/trajopt/whole_body_program.hpp"

#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "trajopt/whole_body_nlp.hpp"

namespace mmgrasp {
namespace {

detail::WholeBodyNlp& whole_body(NonlinearProblem& problem) {
  return static_cast<detail::WholeBodyNlp&>(problem);
}

/// rows x columns of what `at` says.
template <typename At>
Eigen::MatrixXi table(int rows, int columns, At&& at) {
  Eigen::MatrixXi out(rows, columns);
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j) out(i, j) = at(i, j);
  return out;
}

}  // namespace

WholeBodyProgram::WholeBodyProgram(const WholeBodyProblem& problem, const WholeBodyGuess& guess, double smoothing)
    : problem_(problem) {
  problem.check();
  require_not_negative(smoothing, "smoothing");
  const auto nonlinear = std::make_shared<detail::WholeBodyNlp>(problem, smoothing);
  guess_ = nonlinear->pack(guess);
  nonlinear_ = nonlinear;
}

Eigen::MatrixXi WholeBodyProgram::positions() const {
  const detail::WholeBodyLayout& layout = whole_body(*nonlinear_).layout();
  return table(problem_.waypoints(), layout.columns(), [&](int i, int c) { return layout.q(i, c); });
}

Eigen::MatrixXi WholeBodyProgram::velocities() const {
  const detail::WholeBodyLayout& layout = whole_body(*nonlinear_).layout();
  return table(problem_.waypoints(), layout.drives(), [&](int i, int d) { return layout.v(i, d); });
}

Eigen::MatrixXi WholeBodyProgram::accelerations() const {
  const detail::WholeBodyLayout& layout = whole_body(*nonlinear_).layout();
  return table(problem_.intervals(), layout.drives(), [&](int i, int d) { return layout.a(i, d); });
}

Eigen::VectorXi WholeBodyProgram::steps() const {
  const detail::WholeBodyLayout& layout = whole_body(*nonlinear_).layout();
  return table(static_cast<int>(problem_.segments.size()), 1, [&](int s, int) { return layout.h(s); });
}

const Eigen::VectorXd& WholeBodyProgram::checked(const Eigen::VectorXd& x) const {
  require(x.size() == guess_.size(), "x", static_cast<double>(x.size()),
          "must have " + std::to_string(guess_.size()) + " entries, one per variable");
  require_numbers(x, "x");
  const Eigen::VectorXi places = steps();
  for (Eigen::Index s = 0; s < places.size(); ++s)
    require(x[places[s]] > 0, nonlinear_->variable_name(places[s]), x[places[s]], "must be positive");
  return x;
}

WholeBodyTrajectory WholeBodyProgram::trajectory(const Eigen::VectorXd& x) const {
  return whole_body(*nonlinear_).trajectory(checked(x));
}

std::vector<Violation> WholeBodyProgram::violations(const Eigen::VectorXd& x) const {
  return check_whole_body(problem_, trajectory(x));
}

}  // namespace mmgrasp
