#pragma once

#include <Eigen/Core>

namespace mmgrasp::detail {

/// The configuration at a fraction `s` of an interval as a function of its locals: q at its start, drive velocities at
/// both its ends, time step. At s = 0 the locals are q alone.
class IntervalPoint {
 public:
  IntervalPoint(int columns, bool diff_drive, double s);
  int locals() const { return s_ == 0 ? columns_ : columns_ + 2 * drives_ + 1; }
  int columns() const { return columns_; }

  Eigen::VectorXd q(const double* x) const;
  /// d q / d locals.
  Eigen::MatrixXd jacobian(const double* x) const;
  /// Adds sum_c pull_c d2 q_c / d locals2 to H.
  void add_curvature(const double* x, const Eigen::VectorXd& pull, Eigen::MatrixXd& H) const;

 private:
  Eigen::Matrix<double, 6, 1> arc_locals(const double* x) const;
  /// Which locals the variables of a UnicycleArc are.
  Eigen::Matrix<int, 6, 1> arc_places() const;
  int columns_, drives_;
  bool diff_drive_;
  double s_, early_, late_;
};

}  // namespace mmgrasp::detail
