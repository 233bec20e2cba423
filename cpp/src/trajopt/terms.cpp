#include "trajopt/terms.hpp"

#include <cmath>

#include "trajopt/unicycle_arc.hpp"

namespace mmgrasp::detail {
namespace {

using Pattern = std::vector<std::pair<int, int>>;

UnicycleArc::Locals arc_locals(const double* x) {
  return Eigen::Map<const UnicycleArc::Locals>(x + 4);
}

}  // namespace

Pattern Term::jacobian_pattern() const {
  Pattern result;
  for (int i = 0; i < rows(); ++i)
    for (int j = 0; j < static_cast<int>(variables.size()); ++j) result.push_back({i, j});
  return result;
}

Pattern CurvedTerm::hessian_pattern() const {
  Pattern result;
  for (int i = 0; i < static_cast<int>(variables.size()); ++i)
    for (int j = 0; j <= i; ++j) result.push_back({i, j});
  return result;
}

void LinearTerm::value(const double* x, double* out) const {
  *out = 0;
  for (std::size_t i = 0; i < factors_.size(); ++i) *out += factors_[i] * x[i];
}
void LinearTerm::jacobian(const double*, double* out) const {
  for (std::size_t i = 0; i < factors_.size(); ++i) out[i] = factors_[i];
}

void PositionStep::value(const double* x, double* out) const {
  *out = x[1] - x[0] - 0.5 * x[4] * (x[2] + x[3]);
}
void PositionStep::jacobian(const double* x, double* out) const {
  out[0] = -1;
  out[1] = 1;
  out[2] = out[3] = -0.5 * x[4];
  out[4] = -0.5 * (x[2] + x[3]);
}
void PositionStep::hessian(const double*, const double* multipliers, double* out) const {
  out[0] = out[1] = -0.5 * multipliers[0];
}

void VelocityStep::value(const double* x, double* out) const {
  *out = x[1] - x[0] - x[3] * x[2];
}
void VelocityStep::jacobian(const double* x, double* out) const {
  out[0] = -1;
  out[1] = 1;
  out[2] = -x[3];
  out[3] = -x[2];
}
void VelocityStep::hessian(const double*, const double* multipliers, double* out) const {
  out[0] = -multipliers[0];
}

void BulgeTerm::value(const double* x, double* out) const {
  *out = x[0] + 0.5 * x[2] * x[1];
}
void BulgeTerm::jacobian(const double* x, double* out) const {
  out[0] = 1;
  out[1] = 0.5 * x[2];
  out[2] = 0.5 * x[1];
}
void BulgeTerm::hessian(const double*, const double* multipliers, double* out) const {
  out[0] = 0.5 * multipliers[0];
}

void SquareSum::value(const double* x, double* out) const {
  *out = x[0] * x[0] + x[1] * x[1];
}
void SquareSum::jacobian(const double* x, double* out) const {
  out[0] = 2 * x[0];
  out[1] = 2 * x[1];
}
void SquareSum::hessian(const double*, const double* multipliers, double* out) const {
  out[0] = out[1] = 2 * multipliers[0];
}

/// What all rows have in common: heading, velocity and widening at the place, and their derivatives by the variables.
struct WheelTerm::Local {
  using Vector8 = Eigen::Matrix<double, 8, 1>;
  double c, s, vx, vy, omega, wide, wide1, wide2;         // `wide` with its derivatives by h
  Eigen::Matrix<double, 5, 8> by = decltype(by)::Zero();  // of theta, vx, vy, omega and h

  Local(const double* x, double share, double bulge) {
    const double to = 0.5 * share * share, from = share - to, h = x[7];
    const double theta = x[0] + h * (from * x[5] + to * x[6]);
    c = std::cos(theta);
    s = std::sin(theta);
    vx = (1 - share) * x[1] + share * x[2];
    vy = (1 - share) * x[3] + share * x[4];
    omega = (1 - share) * x[5] + share * x[6];
    const double more = bulge * h * h;
    wide = 1 + more + 2 * more * more;
    wide1 = (1 + 4 * more) * 2 * bulge * h;
    wide2 = 2 * bulge * (1 + 12 * more);
    by.row(0) << 1, 0, 0, 0, 0, h * from, h * to, from * x[5] + to * x[6];
    for (int i = 1; i < 4; ++i) {
      by(i, 2 * i - 1) = 1 - share;
      by(i, 2 * i) = share;
    }
    by(4, 7) = 1;
  }
  /// The row's factors of vx and vy, and what it makes of the velocity.
  double along(const Eigen::RowVector3d& row) const { return c * row[0] - s * row[1]; }
  double across(const Eigen::RowVector3d& row) const { return s * row[0] + c * row[1]; }
  double rim(const Eigen::RowVector3d& row) const { return along(row) * vx + across(row) * vy + row[2] * omega; }
  Eigen::Matrix<double, 5, 1> gradient(const Eigen::RowVector3d& row) const {
    Eigen::Matrix<double, 5, 1> g;
    g << wide * (along(row) * vy - across(row) * vx), wide * along(row), wide * across(row), wide * row[2],
        wide1 * rim(row);
    return g;
  }
};

void WheelTerm::value(const double* x, double* out) const {
  const Local local(x, share_, bulge_);
  for (Eigen::Index i = 0; i < wheels_.rows(); ++i) out[i] = local.wide * local.rim(wheels_.row(i));
}
void WheelTerm::jacobian(const double* x, double* out) const {
  const Local local(x, share_, bulge_);
  for (Eigen::Index i = 0; i < wheels_.rows(); ++i)
    Eigen::Map<Local::Vector8>(out + 8 * i) = local.by.transpose() * local.gradient(wheels_.row(i));
}
void WheelTerm::hessian(const double* x, const double* multipliers, double* out) const {
  const Local local(x, share_, bulge_);
  // The sum over rows is linear in them.
  const Eigen::RowVector3d row = Eigen::Map<const Eigen::RowVectorXd>(multipliers, wheels_.rows()) * wheels_;
  const double along = local.along(row), across = local.across(row), turned = along * local.vy - across * local.vx;
  Eigen::Matrix<double, 5, 5> inner = Eigen::Matrix<double, 5, 5>::Zero();
  inner.row(0) << -local.wide * (along * local.vx + across * local.vy), -local.wide * across, local.wide * along, 0,
      local.wide1 * turned;
  inner.row(4) << local.wide1 * turned, local.wide1 * along, local.wide1 * across, local.wide1 * row[2],
      local.wide2 * local.rim(row);
  inner.col(0) = inner.row(0).transpose();
  inner.col(4) = inner.row(4).transpose();
  Eigen::Matrix<double, 8, 8> H = local.by.transpose() * inner * local.by;
  // theta is bilinear in h and the turning rates.
  const double by_theta = local.gradient(row)[0], to = 0.5 * share_ * share_;
  H(7, 5) += by_theta * (share_ - to);
  H(7, 6) += by_theta * to;
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j <= i; ++j) *out++ = H(i, j);
}

void UnicycleStep::value(const double* x, double* out) const {
  UnicycleArc arc;
  arc.evaluate(arc_locals(x), 1, 0);
  out[0] = x[1] - x[0] - arc.way[0];
  out[1] = x[3] - x[2] - arc.way[1];
}
Pattern UnicycleStep::jacobian_pattern() const {
  Pattern result{{0, 0}, {0, 1}, {1, 2}, {1, 3}};
  for (int i = 0; i < 2; ++i)
    for (int j = 4; j < 10; ++j) result.push_back({i, j});
  return result;
}
void UnicycleStep::jacobian(const double* x, double* out) const {
  UnicycleArc arc;
  arc.evaluate(arc_locals(x), 1, 1);
  out[0] = out[2] = -1;
  out[1] = out[3] = 1;
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 6; ++j) out[4 + 6 * i + j] = -arc.J(i, j);
}
Pattern UnicycleStep::hessian_pattern() const {
  Pattern result;
  for (int i = 4; i < 10; ++i)
    for (int j = 4; j <= i; ++j) result.push_back({i, j});
  return result;
}
void UnicycleStep::hessian(const double* x, const double* multipliers, double* out) const {
  UnicycleArc arc;
  arc.evaluate(arc_locals(x), 1, 2);
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j <= i; ++j) *out++ = -multipliers[0] * arc.H[0](i, j) - multipliers[1] * arc.H[1](i, j);
}

}  // namespace mmgrasp::detail
