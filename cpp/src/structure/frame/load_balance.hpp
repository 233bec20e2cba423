#pragma once

#include <Eigen/Geometry>
#include <algorithm>

namespace mmgrasp::detail {

/// Sums the wrenches on a frame, and of what size they are: an answer whose reactions do not carry its loads has lost
/// its digits.
template <class Scalar>
struct LoadBalance {
  using Vector3 = Eigen::Matrix<Scalar, 3, 1>;
  static constexpr double kTolerance = 1e-10;  ///< Share of the loads.
  Vector3 force = Vector3::Zero(), moment = Vector3::Zero();
  double forces = 0, moments = 0, arm = 0;

  template <class Wrench>
  void add(const Vector3& place, const Wrench& wrench) {
    const Vector3 f = wrench.template head<3>(), m = wrench.template tail<3>();
    force += f;
    moment += place.cross(f) + m;
    const double reach = static_cast<double>(place.norm()), size = static_cast<double>(f.norm());
    arm = std::max(arm, reach);
    forces += size;
    moments += reach * size + static_cast<double>(m.norm());
  }
  bool holds() const {
    const double pairs = arm > 0 ? moments / arm : 0;
    return static_cast<double>(force.norm()) <= kTolerance * (forces + pairs) &&
           static_cast<double>(moment.norm()) <= kTolerance * (moments + arm * forces);
  }
};

}  // namespace mmgrasp::detail
