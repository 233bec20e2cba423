#include "trajopt/terms.hpp"

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
