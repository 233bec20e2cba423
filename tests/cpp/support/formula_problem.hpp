#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "mmgrasp/optim/nonlinear_problem.hpp"
#include "support/second_order.hpp"

namespace mmgrasp::test {

constexpr double kInf = std::numeric_limits<double>::infinity();
using Formula = std::function<SecondOrder(const std::vector<SecondOrder>& x)>;

/// A nonlinear problem of formulas, with full patterns.
class FormulaProblem : public NonlinearProblem {
 public:
  struct Row {
    Formula f;
    double lower, upper;
  };
  FormulaProblem(Formula objective, std::vector<Row> rows, const Eigen::VectorXd& lower, const Eigen::VectorXd& upper)
      : objective_(std::move(objective)), rows_(std::move(rows)), x_bounds_{lower, upper} {
    const int n = static_cast<int>(lower.size()), m = static_cast<int>(rows_.size());
    c_bounds_.lower.resize(m);
    c_bounds_.upper.resize(m);
    for (int i = 0; i < m; ++i) {
      c_bounds_.lower[i] = rows_[i].lower;
      c_bounds_.upper[i] = rows_[i].upper;
      for (int j = 0; j < n; ++j) jacobian_.add(i, j);
    }
    for (int i = 0; i < n; ++i)
      for (int j = 0; j <= i; ++j) hessian_.add(i, j);
  }
  Bounds variable_bounds() const override { return x_bounds_; }
  Bounds constraint_bounds() const override { return c_bounds_; }
  double objective(const Eigen::VectorXd& x) override {
    ++evaluations;
    if (on_evaluation) on_evaluation();
    return objective_(lifted(x)).value;
  }
  void gradient(const Eigen::VectorXd& x, Eigen::Ref<Eigen::VectorXd> out) override { out = objective_(lifted(x)).g; }
  void constraints(const Eigen::VectorXd& x, Eigen::Ref<Eigen::VectorXd> out) override {
    for (std::size_t i = 0; i < rows_.size(); ++i) out[static_cast<Eigen::Index>(i)] = rows_[i].f(lifted(x)).value;
  }
  const SparsePattern& jacobian_pattern() const override { return jacobian_; }
  void jacobian(const Eigen::VectorXd& x, Eigen::Ref<Eigen::VectorXd> values) override {
    for (std::size_t i = 0; i < rows_.size(); ++i)
      values.segment(static_cast<Eigen::Index>(i) * x.size(), x.size()) = rows_[i].f(lifted(x)).g;
  }
  const SparsePattern& hessian_pattern() const override { return hessian_; }
  void hessian(const Eigen::VectorXd& x, double factor, const Eigen::VectorXd& multipliers,
               Eigen::Ref<Eigen::VectorXd> values) override {
    Eigen::MatrixXd H = factor * objective_(lifted(x)).H;
    for (std::size_t i = 0; i < rows_.size(); ++i)
      H += multipliers[static_cast<Eigen::Index>(i)] * rows_[i].f(lifted(x)).H;
    for (std::size_t i = 0; i < hessian_.size(); ++i)
      values[static_cast<Eigen::Index>(i)] = H(hessian_.rows[i], hessian_.columns[i]);
  }

  int evaluations = 0;
  std::function<void()> on_evaluation;

 private:
  static std::vector<SecondOrder> lifted(const Eigen::VectorXd& x) {
    std::vector<SecondOrder> result;
    for (Eigen::Index i = 0; i < x.size(); ++i) result.push_back(SecondOrder::variable(x[i], x.size(), i));
    return result;
  }
  Formula objective_;
  std::vector<Row> rows_;
  Bounds x_bounds_, c_bounds_;
  SparsePattern jacobian_, hessian_;
};

}  // namespace mmgrasp::test
