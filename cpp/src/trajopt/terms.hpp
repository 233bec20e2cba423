#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "mmgrasp/optim/nonlinear_problem.hpp"

namespace mmgrasp::detail {

/// A few rows of constraints on a few variables. Everything is written in the term's own numbering: value and bounds of
/// its rows, the non-zeros of its Jacobian, the lower triangle of its Hessian, each in the order of the pattern.
class MMGRASP_EXPORT Term {
 public:
  virtual ~Term() = default;
  std::vector<int> variables;  ///< Indices of the variables in the problem.
  Eigen::VectorXd lower, upper;
  std::string kind;  ///< Kind of constraint, for reports.
  int waypoint = 0;
  std::string what;

  int rows() const { return static_cast<int>(lower.size()); }
  virtual void value(const double* x, double* out) const = 0;
  virtual std::vector<std::pair<int, int>> jacobian_pattern() const;  ///< Every row and variable unless overridden.
  virtual void jacobian(const double* x, double* out) const = 0;
  virtual std::vector<std::pair<int, int>> hessian_pattern() const { return {}; }  ///< Row >= column.
  virtual void hessian(const double*, const double*, double*) const {}
};

/// A term whose second derivatives join all of its variables.
class CurvedTerm : public Term {
 public:
  std::vector<std::pair<int, int>> hessian_pattern() const override;
  void hessian(const double* x, const double* multipliers, double* out) const override = 0;
};

/// lower <= sum_i factor_i x_i <= upper.
class LinearTerm : public Term {
 public:
  explicit LinearTerm(std::vector<double> factors) : factors_(std::move(factors)) {}
  void value(const double* x, double* out) const override;
  void jacobian(const double*, double* out) const override;

 private:
  std::vector<double> factors_;
};

/// q1 - q0 - h (v0 + v1) / 2 = 0 (P1 4.6). Variables q0, q1, v0, v1, h.
class PositionStep : public Term {
 public:
  void value(const double* x, double* out) const override;
  void jacobian(const double* x, double* out) const override;
  std::vector<std::pair<int, int>> hessian_pattern() const override { return {{4, 2}, {4, 3}}; }
  void hessian(const double*, const double* multipliers, double* out) const override;
};

/// v1 - v0 - h a = 0. Variables v0, v1, a, h.
class VelocityStep : public Term {
 public:
  void value(const double* x, double* out) const override;
  void jacobian(const double* x, double* out) const override;
  std::vector<std::pair<int, int>> hessian_pattern() const override { return {{3, 2}}; }
  void hessian(const double*, const double* multipliers, double* out) const override;
};

/// lower <= q + h v / 2 <= upper: with its neighbours' bounds it keeps the parabola between two waypoints inside, since
/// a parabola lies in the hull of its Bezier points. Variables q, v, h.
class BulgeTerm : public Term {
 public:
  void value(const double* x, double* out) const override;
  void jacobian(const double* x, double* out) const override;
  std::vector<std::pair<int, int>> hessian_pattern() const override { return {{2, 1}}; }
  void hessian(const double*, const double* multipliers, double* out) const override;
};

/// a^2 + b^2 <= upper. Variables a, b.
class SquareSum : public Term {
 public:
  void value(const double* x, double* out) const override;
  void jacobian(const double* x, double* out) const override;
  std::vector<std::pair<int, int>> hessian_pattern() const override { return {{0, 0}, {1, 1}}; }
  void hessian(const double*, const double* multipliers, double* out) const override;
};

/// |row (R(theta)^T v, omega)| (1 + x + 2 x^2) <= upper for each row on the base's velocity in its own frame, at a
/// share of an interval in which v and omega of an omni base change linearly and theta follows; x = bulge h^2 <= 1/2
/// makes up for what lies between two such places, which may be more by the share x (1 / (1 - x) <= 1 + x + 2 x^2).
/// Variables theta0, vx0, vx1, vy0, vy1, omega0, omega1, h.
class WheelTerm : public CurvedTerm {
 public:
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, 3>;
  WheelTerm(Rows wheels, double share, double bulge) : wheels_(std::move(wheels)), share_(share), bulge_(bulge) {}
  void value(const double* x, double* out) const override;
  void jacobian(const double* x, double* out) const override;
  void hessian(const double* x, const double* multipliers, double* out) const override;

 private:
  struct Local;
  Rows wheels_;
  double share_, bulge_;
};

/// x1 - x0 and y1 - y0 equal the way of a unicycle. Variables x0, x1, y0, y1, theta0, omega0, omega1, v0, v1, h.
class UnicycleStep : public Term {
 public:
  void value(const double* x, double* out) const override;
  std::vector<std::pair<int, int>> jacobian_pattern() const override;
  void jacobian(const double* x, double* out) const override;
  std::vector<std::pair<int, int>> hessian_pattern() const override;
  void hessian(const double*, const double* multipliers, double* out) const override;
};

}  // namespace mmgrasp::detail
