#pragma once

#include <Eigen/Core>

#include "mmgrasp/core/export.hpp"

namespace mmgrasp::detail {

/// Way of a unicycle whose speed v and turning rate omega are linear over an interval of h seconds, up to the fraction
/// s of it. Its variables in order: theta0, omega0, omega1, v0, v1, h. Gauss-Legendre quadrature; heading and its
/// derivatives are exact.
struct MMGRASP_EXPORT UnicycleArc {
  using Locals = Eigen::Matrix<double, 6, 1>;
  Eigen::Vector2d way;                                             ///< x(s) - x(0), y(s) - y(0)
  Eigen::Matrix<double, 2, 6> J;                                   ///< With respect to the variables.
  Eigen::Matrix<double, 6, 6> H[2];                                ///< Second derivatives of both.
  void evaluate(const Locals& locals, double s, int derivatives);  ///< 0: way, 1: and J, 2: and H.
};

/// theta(s) - theta(0) of the same motion.
inline double unicycle_turn(const UnicycleArc::Locals& l, double s) {
  return l[5] * (l[1] * (s - 0.5 * s * s) + l[2] * 0.5 * s * s);
}

}  // namespace mmgrasp::detail
