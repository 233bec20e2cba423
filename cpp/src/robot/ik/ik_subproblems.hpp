#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"

namespace mmgrasp::detail {

/// The elementary problems that closed-form inverse kinematics is made of: which turns about given axes bring one
/// vector to another, to a distance or to a plane (after Paden and Kahan). Axes are unit vectors.

/// Up to two angles. `free` says that every angle solves the problem; the one given is 0.
struct AngleSolutions {
  std::array<double, 2> value{};
  int count = 0;
  bool free = false;

  void add(double angle) { value[count++] = angle; }
  const double* begin() const { return value.data(); }
  const double* end() const { return value.data() + count; }
};

/// The turn about an axis by one angle, for several vectors.
class Turn {
 public:
  Turn(const Eigen::Vector3d& axis, double angle) : axis_(axis), c_(std::cos(angle)), s_(std::sin(angle)) {}
  Eigen::Vector3d operator()(const Eigen::Vector3d& x) const { return apply(s_, x); }
  Eigen::Vector3d back(const Eigen::Vector3d& x) const { return apply(-s_, x); }

 private:
  Eigen::Vector3d apply(double s, const Eigen::Vector3d& x) const {
    return c_ * x + s * axis_.cross(x) + (1 - c_) * axis_.dot(x) * axis_;
  }
  Eigen::Vector3d axis_;
  double c_, s_;
};

inline Eigen::Vector3d turned(const Eigen::Vector3d& axis, double angle, const Eigen::Vector3d& x) {
  return Turn(axis, angle)(x);
}

/// a cos(angle) + b sin(angle) = c. What misses a solution by a little (geometry that is only nearly special, poses at
/// the border of reach) gives the nearest angle: Newton's method decides about it afterwards.
inline AngleSolutions solve_cosine(double a, double b, double c) {
  constexpr double kSlack = 1e-3, kDegenerate = 1e-9;
  AngleSolutions angles;
  const double r = std::hypot(a, b);
  if (r < kDegenerate) {
    if (std::abs(c) < 1e3 * kDegenerate) {
      angles.add(0);
      angles.free = true;
    }
    return angles;
  }
  const double ratio = c / r;
  if (!(std::abs(ratio) <= 1 + kSlack)) return angles;
  const double middle = std::atan2(b, a);
  if (std::abs(ratio) >= 1) {
    angles.add(ratio > 0 ? middle : middle + kPi);
    return angles;
  }
  const double half = std::acos(ratio);
  angles.add(middle + half);
  angles.add(middle - half);
  return angles;
}

/// The turn about `axis` that brings u closest to v; 0 when any does, and `free` is set then.
inline double angle_onto(const Eigen::Vector3d& axis, const Eigen::Vector3d& u, const Eigen::Vector3d& v, bool& free) {
  const double sine = axis.dot(u.cross(v)), cosine = u.dot(v) - axis.dot(u) * axis.dot(v);
  if (sine * sine + cosine * cosine >= 1e-24) return std::atan2(sine, cosine);
  free = true;
  return 0;
}

/// k . R(axis, angle) u = d
inline AngleSolutions angles_to_plane(const Eigen::Vector3d& axis, const Eigen::Vector3d& k, const Eigen::Vector3d& u,
                                      double d) {
  const double along = k.dot(axis) * axis.dot(u);
  return solve_cosine(k.dot(u) - along, k.dot(axis.cross(u)), d - along);
}

/// |R(axis, angle) u - v| = d
inline AngleSolutions angles_to_distance(const Eigen::Vector3d& axis, const Eigen::Vector3d& u,
                                         const Eigen::Vector3d& v, double d) {
  return angles_to_plane(axis, v, u, 0.5 * (u.squaredNorm() + v.squaredNorm() - d * d));
}

}  // namespace mmgrasp::detail
