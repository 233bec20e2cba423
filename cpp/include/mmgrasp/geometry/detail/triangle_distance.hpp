#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace mmgrasp::detail {

/// Distance of point p from the segment between a and b.
inline double segment_distance(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d ab = b - a;
  const double length = ab.squaredNorm();
  const double s = length > 0 ? std::clamp((p - a).dot(ab) / length, 0.0, 1.0) : 0.0;
  return (p - a - s * ab).norm();
}

/// Distance of point p from the triangle a, b, c, which may be degenerate.
inline double triangle_distance(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                const Eigen::Vector3d& c) {
  const Eigen::Vector3d n = (b - a).cross(c - a);
  const double area = n.norm();
  // Above the inside of the triangle the plane is nearest; else an edge is.
  if (area > 0 && n.dot((b - a).cross(p - a)) >= 0 && n.dot((c - b).cross(p - b)) >= 0 &&
      n.dot((a - c).cross(p - c)) >= 0)
    return std::abs(n.dot(p - a)) / area;
  return std::min({segment_distance(p, a, b), segment_distance(p, b, c), segment_distance(p, c, a)});
}

}  // namespace mmgrasp::detail
