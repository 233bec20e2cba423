#pragma once

#include <memory>
#include <vector>

#include "mmgrasp/optim/nonlinear_problem.hpp"
#include "mmgrasp/trajopt/optimize_whole_body.hpp"
#include "mmgrasp/trajopt/whole_body_problem.hpp"
#include "trajopt/terms.hpp"

namespace mmgrasp::detail {

/// The order of a whole-body problem's numbers in one vector: per waypoint q, drive velocity, and (but for the
/// last) drive acceleration of the interval after it; the time step of a segment before its first waypoint.
class MMGRASP_EXPORT WholeBodyLayout {
 public:
  explicit WholeBodyLayout(const WholeBodyProblem& problem);
  int size() const { return size_; }
  int q(int waypoint, int column) const { return first_[waypoint] + column; }
  int v(int waypoint, int drive) const { return q(waypoint, columns_) + drive; }
  int a(int waypoint, int drive) const { return v(waypoint, drives_) + drive; }
  int h(int segment) const { return step_[segment]; }
  /// Segment that the interval after a waypoint belongs to.
  int segment(int interval) const { return segment_[interval]; }
  int columns() const { return columns_; }
  int drives() const { return drives_; }
  int intervals() const { return static_cast<int>(segment_.size()); }
  /// Name of the number at an index, for messages.
  std::string name(int index, const JointGroup& group) const;

 private:
  int columns_, drives_, size_ = 0;
  std::vector<int> first_, step_, segment_;
};

/// P1's (4.1)-(4.9) as a sparse nonlinear problem.
class MMGRASP_EXPORT WholeBodyNlp : public NonlinearProblem {
 public:
  WholeBodyNlp(const WholeBodyProblem& problem, double smoothing);

  const WholeBodyLayout& layout() const { return layout_; }
  void add(std::unique_ptr<Term> term);  ///< Not while a solver runs.
  const std::vector<std::unique_ptr<Term>>& terms() const { return terms_; }

  Eigen::VectorXd pack(const WholeBodyGuess& guess) const;
  WholeBodyTrajectory trajectory(const Eigen::VectorXd& x) const;

  Bounds variable_bounds() const override { return bounds_; }
  Bounds constraint_bounds() const override;
  double objective(const Eigen::VectorXd& x) override;
  void gradient(const Eigen::VectorXd& x, Eigen::Ref<Eigen::VectorXd> out) override;
  void constraints(const Eigen::VectorXd& x, Eigen::Ref<Eigen::VectorXd> out) override;
  const SparsePattern& jacobian_pattern() const override { return jacobian_; }
  void jacobian(const Eigen::VectorXd& x, Eigen::Ref<Eigen::VectorXd> values) override;
  const SparsePattern& hessian_pattern() const override { return hessian_; }
  void hessian(const Eigen::VectorXd& x, double factor, const Eigen::VectorXd& multipliers,
               Eigen::Ref<Eigen::VectorXd> values) override;
  std::string variable_name(int index) const override { return layout_.name(index, problem_.group); }
  std::string constraint_name(int index) const override;

 private:
  void bound_variables();
  void add_motion();
  void add_limits();
  void add_mecanum_wheels();
  void add_tool();
  const double* gathered(const Term& term, const Eigen::VectorXd& x);

  WholeBodyProblem problem_;
  WholeBodyLayout layout_;
  Eigen::VectorXd smoothing_;  ///< Per drive: factor of the square of each acceleration.
  Bounds bounds_;
  std::vector<std::unique_ptr<Term>> terms_;
  std::vector<std::size_t> jacobian_at_, hessian_at_;  ///< Where each term's values begin.
  std::vector<int> row_at_;
  int rows_ = 0;
  SparsePattern jacobian_, hessian_;
  std::vector<double> local_;
};

}  // namespace mmgrasp::detail
