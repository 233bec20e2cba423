#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

#include "mmgrasp/core/detail/rigid.hpp"

namespace mmgrasp::detail {

enum class ConvexKind { point, segment, box, cylinder, hull };

/// A convex body as GJK sees it: a core given by its support function, grown by `radius`.
struct Convex {
  ConvexKind kind = ConvexKind::point;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< Inner point; the core's middle except for hulls.
  Eigen::Vector3d half =
      Eigen::Vector3d::Zero();     ///< Box: half lengths. Cylinder: (radius, radius, half length). Segment: z.
  double radius = 0;               ///< Rounding [m]; spheres and capsules are made of it.
  const double* points = nullptr;  ///< Hull: x of all points, then y, then z. Owned by someone else.
  const float* rough = nullptr;    ///< The same in single precision, or null.
  int count = 0;                   ///< Hull: points; a multiple of kLanes unless it is 3 (a triangle).
  double rough_error = 0;          ///< How much nearer than the farthest point one of support_roughly() may lie [m].

  /// A point of the core farthest along d (d need not be a unit vector).
  Eigen::Vector3d support(const Eigen::Vector3d& d) const;
  /// The same for proofs that count with `rough_error`.
  Eigen::Vector3d support_roughly(const Eigen::Vector3d& d) const;
};

/// True when the bodies, b placed at `b_in_a`, come within `margin` of each other. `axis` (frame of a, from b to a) is
/// where the search starts; on return it is the last search direction, which separates the bodies when the answer is
/// false.
bool convex_collide(const Convex& a, const Convex& b, const Rigid& b_in_a, double margin, Eigen::Vector3d& axis);

/// Separating axis test of two boxes: false only if they are apart by more than `margin` along one of the 15 axes.
/// Exact for margin 0. `t` is the centre of b in the frame of a, `R` its rotation.
inline bool boxes_overlap(const Eigen::Vector3d& ha, const Eigen::Vector3d& hb, const Eigen::Matrix3d& R,
                          const Eigen::Matrix3d& abs_R, const Eigen::Vector3d& t, double margin) {
  for (int i = 0; i < 3; ++i) {
    if (std::abs(t[i]) > ha[i] + margin + abs_R(i, 0) * hb[0] + abs_R(i, 1) * hb[1] + abs_R(i, 2) * hb[2]) return false;
  }
  for (int j = 0; j < 3; ++j) {
    const double s = t[0] * R(0, j) + t[1] * R(1, j) + t[2] * R(2, j);
    if (std::abs(s) > hb[j] + margin + abs_R(0, j) * ha[0] + abs_R(1, j) * ha[1] + abs_R(2, j) * ha[2]) return false;
  }
  // Edge against edge. Nearly parallel edges give axes of rounding noise: the slack keeps those from deciding.
  const double slack = margin + 1e-14 * (ha[0] + ha[1] + ha[2] + hb[0] + hb[1] + hb[2]);
  for (int i = 0; i < 3; ++i) {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
    for (int j = 0; j < 3; ++j) {
      const int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      const double s = t[i2] * R(i1, j) - t[i1] * R(i2, j);
      const double r = ha[i1] * abs_R(i2, j) + ha[i2] * abs_R(i1, j) + hb[j1] * abs_R(i, j2) + hb[j2] * abs_R(i, j1);
      if (std::abs(s) > r + slack) return false;
    }
  }
  return true;
}

}  // namespace mmgrasp::detail
