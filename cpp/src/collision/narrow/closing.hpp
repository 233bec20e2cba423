#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/rigid.hpp"

namespace mmgrasp::detail {

/// How one of two bodies moves against the other from where it is, over a stretch of an edge, forwards or backwards. No
/// point of it moves farther than `most` [m]; where `directed` is set, a point p moves along shift + turn x (p -
/// centre), but for `bend` [m], and a sphere of `radius` about the centre holds the body. With `two_motions` it moves
/// by a second such motion too, forwards or backwards whatever the first does.
struct Closing {
  double most = 0;
  bool directed = false, two_motions = false;
  bool first_moves = false;  ///< Whether the first of the two bodies moves; the other one stands still.
  Eigen::Vector3d centre = Eigen::Vector3d::Zero(), shift = Eigen::Vector3d::Zero(), turn = Eigen::Vector3d::Zero();
  Eigen::Vector3d second_shift = Eigen::Vector3d::Zero(), second_turn = Eigen::Vector3d::Zero();
  double radius = 0, bend = 0;
  double by_rates =
      0;  ///< A bound of `most` that grows evenly along the stretch [m]; `speed` likewise, but for `bend`.
  double speed = 0;

  /// How far the body's points move along n, times the length of n.
  double along(const Eigen::Vector3d& n) const {
    const double length = n.norm();
    if (!directed) return most * length;
    double way = std::abs(n.dot(shift)) + n.cross(turn).norm() * radius + bend * length;
    if (two_motions) way += std::abs(n.dot(second_shift)) + n.cross(second_turn).norm() * radius;
    return std::min(most * length, way);
  }
  /// The same for one of its points and a unit vector.
  double along_at(const Eigen::Vector3d& n, const Eigen::Vector3d& point) const {
    const double second = two_motions ? std::abs(n.dot(second_shift + second_turn.cross(point - centre))) : 0;
    return std::abs(n.dot(shift + turn.cross(point - centre))) + second + bend;
  }
  /// How much of the stretch (up to 1, all of it) has surely passed before a point has moved by `way` [m]. Not with
  /// `two_motions`.
  double share(double way) const {
    if (way > most) return 1;
    if (!(way > kRounding)) return 0;
    way -= kRounding;
    double out = way / by_rates;
    if (directed) out = std::max(out, root(speed, bend, way));
    return std::min(out, 1.0);
  }
  /// The same for `way` along n, times the length of n.
  double share_along(const Eigen::Vector3d& n, double way) const {
    const double length = n.norm();
    double out = share(way / length);
    way -= kRounding * length;
    if (directed && way > 0)
      out = std::max(out, root(std::abs(n.dot(shift)) + n.cross(turn).norm() * radius, bend * length, way));
    return std::min(out, 1.0);
  }
  Closing seen_from(const Rigid& frame) const {
    Closing out = *this;
    out.centre = frame.R.transpose() * (centre - frame.t);
    out.shift = frame.R.transpose() * shift;
    out.turn = frame.R.transpose() * turn;
    if (two_motions) {
      out.second_shift = frame.R.transpose() * second_shift;
      out.second_turn = frame.R.transpose() * second_turn;
    }
    return out;
  }
  Closing swapped() const {
    Closing out = *this;
    out.first_moves = !first_moves;
    return out;
  }

 private:
  /// The bounds hold a fixed slack, which does not shrink with the stretch [m].
  static constexpr double kRounding = 3e-7;
  /// The share s for which speed * s + bend * s * s = way; infinite where there is no motion.
  static double root(double speed, double bend, double way) {
    return 2 * way / (speed + std::sqrt(speed * speed + 4 * bend * way));
  }
};

}  // namespace mmgrasp::detail
