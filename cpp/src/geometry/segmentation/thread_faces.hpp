#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <optional>

#include "geometry/segmentation/face_graph.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/geometry/segment_mesh.hpp"

namespace mmgrasp::detail {

/// The axis and the pitch of a screw motion.
struct Helix {
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ(), point = Eigen::Vector3d::Zero();
  double pitch_per_radian = 0;  ///< Along the axis [m/rad].
};

/// Height, radius and direction from the axis of a point in a helix' frame.
struct HelixPlace {
  double height, radius;
  Eigen::Vector3d outward;
};

inline HelixPlace place_at(const Helix& helix, const Eigen::Vector3d& x) {
  const Eigen::Vector3d d = x - helix.point;
  HelixPlace out;
  out.height = d.dot(helix.axis);
  const Eigen::Vector3d radial = d - out.height * helix.axis;
  out.radius = radial.norm();
  out.outward = out.radius > 0 ? Eigen::Vector3d(radial / out.radius) : Eigen::Vector3d::Zero();
  return out;
}

/// From the least to the most of what was added.
struct HelixSpan {
  double low = kInfinity, high = -kInfinity;
  void add(double x) {
    low = std::min(low, x);
    high = std::max(high, x);
  }
};

/// The thread around the edges of its root, which reach from one height to the other at a radius of about `root` [m]:
/// its faces and its true radii. None where there is none.
std::optional<ScrewThread> thread_around(const FaceGraph& graph, const Helix& helix, const HelixSpan& heights,
                                         double root);

}  // namespace mmgrasp::detail
