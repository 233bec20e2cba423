#pragma once

#include <Eigen/Core>
#include <cmath>

namespace mmgrasp::test {

/// A number with its gradient and its Hessian: exact derivatives of formulas written once.
struct SecondOrder {
  double value = 0;
  Eigen::VectorXd g;
  Eigen::MatrixXd H;

  SecondOrder() = default;
  SecondOrder(double v, Eigen::Index n) : value(v), g(Eigen::VectorXd::Zero(n)), H(Eigen::MatrixXd::Zero(n, n)) {}
  static SecondOrder variable(double v, Eigen::Index n, Eigen::Index i) {
    SecondOrder x(v, n);
    x.g[i] = 1;
    return x;
  }
  /// f(this) with f's value and first two derivatives.
  SecondOrder through(double f, double df, double ddf) const {
    SecondOrder r(f, g.size());
    r.g = df * g;
    r.H = df * H + ddf * g * g.transpose();
    return r;
  }
};

inline SecondOrder operator+(SecondOrder a, const SecondOrder& b) {
  a.value += b.value;
  a.g += b.g;
  a.H += b.H;
  return a;
}
inline SecondOrder operator*(const SecondOrder& a, const SecondOrder& b) {
  SecondOrder r(a.value * b.value, a.g.size());
  r.g = a.value * b.g + b.value * a.g;
  r.H = a.value * b.H + b.value * a.H + a.g * b.g.transpose() + b.g * a.g.transpose();
  return r;
}
inline SecondOrder operator*(double s, const SecondOrder& a) {
  return a.through(s * a.value, s, 0);
}
inline SecondOrder operator-(const SecondOrder& a, const SecondOrder& b) {
  return a + -1.0 * b;
}
inline SecondOrder operator+(const SecondOrder& a, double s) {
  return a.through(a.value + s, 1, 0);
}
inline SecondOrder operator-(const SecondOrder& a, double s) {
  return a + -s;
}
inline SecondOrder operator-(double s, const SecondOrder& a) {
  return -1.0 * a + s;
}
inline SecondOrder pow(const SecondOrder& a, int k) {
  return a.through(std::pow(a.value, k), k * std::pow(a.value, k - 1), k * (k - 1) * std::pow(a.value, k - 2));
}
inline SecondOrder exp(const SecondOrder& a) {
  const double e = std::exp(a.value);
  return a.through(e, e, e);
}
inline SecondOrder log(const SecondOrder& a) {
  return a.through(std::log(a.value), 1 / a.value, -1 / (a.value * a.value));
}
inline SecondOrder sin(const SecondOrder& a) {
  return a.through(std::sin(a.value), std::cos(a.value), -std::sin(a.value));
}

}  // namespace mmgrasp::test
