#include "trajopt/unicycle_arc.hpp"

#include <cmath>

namespace mmgrasp::detail {
namespace {

// Gauss-Legendre on [0, 1], eight points.
constexpr int kPoints = 8;
constexpr double kNodes[] = {0.019855071751231856, 0.10166676129318664, 0.2372337950418355, 0.4082826787521751,
                             0.591717321247825,    0.7627662049581645,  0.8983332387068134, 0.9801449282487682};
constexpr double kWeights[] = {0.05061426814518815, 0.11119051722668725, 0.15685332293894366, 0.181341891689181,
                               0.181341891689181,   0.15685332293894366, 0.11119051722668725, 0.05061426814518815};

}  // namespace

void UnicycleArc::evaluate(const Locals& l, double s, int derivatives) {
  way.setZero();
  if (derivatives > 0) J.setZero();
  if (derivatives > 1) {
    H[0].setZero();
    H[1].setZero();
  }
  const double h = l[5];
  for (int k = 0; k < kPoints; ++k) {
    const double at = s * kNodes[k], weight = s * kWeights[k];
    const double early = at - 0.5 * at * at, late = 0.5 * at * at;  // shares of omega0, omega1 in the turn
    const double rate = l[1] * early + l[2] * late, heading = l[0] + h * rate;
    const double speed = l[3] * (1 - at) + l[4] * at;
    const double c = std::cos(heading), sn = std::sin(heading);
    const double A = weight * h * speed;
    way += A * Eigen::Vector2d(c, sn);
    if (derivatives == 0) continue;
    Locals dA = Locals::Zero(), dT;
    dA[3] = weight * h * (1 - at);
    dA[4] = weight * h * at;
    dA[5] = weight * speed;
    dT << 1, h * early, h * late, 0, 0, rate;
    J.row(0) += (c * dA - A * sn * dT).transpose();
    J.row(1) += (sn * dA + A * c * dT).transpose();
    if (derivatives == 1) continue;
    Eigen::Matrix<double, 6, 6> ddA = Eigen::Matrix<double, 6, 6>::Zero(), ddT = ddA;
    ddA(3, 5) = ddA(5, 3) = weight * (1 - at);
    ddA(4, 5) = ddA(5, 4) = weight * at;
    ddT(1, 5) = ddT(5, 1) = early;
    ddT(2, 5) = ddT(5, 2) = late;
    const Eigen::Matrix<double, 6, 6> mixed = dA * dT.transpose() + dT * dA.transpose();
    const Eigen::Matrix<double, 6, 6> square = dT * dT.transpose();
    H[0] += c * ddA - sn * mixed - A * c * square - A * sn * ddT;
    H[1] += sn * ddA + c * mixed - A * sn * square + A * c * ddT;
  }
}

}  // namespace mmgrasp::detail
