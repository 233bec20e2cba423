#include "trajopt/interval_point.hpp"

#include "trajopt/unicycle_arc.hpp"

namespace mmgrasp::detail {

using Eigen::MatrixXd;
using Eigen::VectorXd;

IntervalPoint::IntervalPoint(int columns, bool diff_drive, double s)
    : columns_(columns),
      drives_(columns - (diff_drive ? 1 : 0)),
      diff_drive_(diff_drive),
      s_(s),
      early_(s - 0.5 * s * s),
      late_(0.5 * s * s) {}

Eigen::Matrix<double, 6, 1> IntervalPoint::arc_locals(const double* x) const {
  Eigen::Matrix<double, 6, 1> l;
  const double *v0 = x + columns_, *v1 = v0 + drives_;
  l << x[2], v0[1], v1[1], v0[0], v1[0], v1[drives_];
  return l;
}

Eigen::Matrix<int, 6, 1> IntervalPoint::arc_places() const {
  const int v0 = columns_, v1 = v0 + drives_;
  Eigen::Matrix<int, 6, 1> places;
  places << 2, v0 + 1, v1 + 1, v0, v1, v1 + drives_;
  return places;
}

VectorXd IntervalPoint::q(const double* x) const {
  VectorXd q = Eigen::Map<const VectorXd>(x, columns_);
  if (s_ == 0) return q;
  const double *v0 = x + columns_, *v1 = v0 + drives_, h = v1[drives_];
  const int first = diff_drive_ ? 1 : 0;
  for (int d = first; d < drives_; ++d) q[d + first] += h * (v0[d] * early_ + v1[d] * late_);
  if (!diff_drive_) return q;
  UnicycleArc arc;
  arc.evaluate(arc_locals(x), s_, 0);
  q.head<2>() += arc.way;
  return q;
}

MatrixXd IntervalPoint::jacobian(const double* x) const {
  MatrixXd D = MatrixXd::Zero(columns_, locals());
  D.leftCols(columns_).setIdentity();
  if (s_ == 0) return D;
  const int v0 = columns_, v1 = v0 + drives_, h = v1 + drives_, first = diff_drive_ ? 1 : 0;
  for (int d = first; d < drives_; ++d) {
    const int c = d + first;
    D(c, v0 + d) = x[h] * early_;
    D(c, v1 + d) = x[h] * late_;
    D(c, h) = x[v0 + d] * early_ + x[v1 + d] * late_;
  }
  if (!diff_drive_) return D;
  UnicycleArc arc;
  arc.evaluate(arc_locals(x), s_, 1);
  const Eigen::Matrix<int, 6, 1> places = arc_places();
  for (int i = 0; i < 6; ++i) {
    D(0, places[i]) += arc.J(0, i);
    D(1, places[i]) += arc.J(1, i);
  }
  return D;
}

void IntervalPoint::add_curvature(const double* x, const VectorXd& pull, MatrixXd& H) const {
  if (s_ == 0) return;
  const int v0 = columns_, v1 = v0 + drives_, h = v1 + drives_, first = diff_drive_ ? 1 : 0;
  const auto add = [&](int i, int j, double value) {
    H(i, j) += value;
    H(j, i) += value;
  };
  for (int d = first; d < drives_; ++d) {
    add(h, v0 + d, pull[d + first] * early_);
    add(h, v1 + d, pull[d + first] * late_);
  }
  if (!diff_drive_) return;
  UnicycleArc arc;
  arc.evaluate(arc_locals(x), s_, 2);
  const Eigen::Matrix<int, 6, 1> places = arc_places();
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) H(places[i], places[j]) += pull[0] * arc.H[0](i, j) + pull[1] * arc.H[1](i, j);
}

}  // namespace mmgrasp::detail
