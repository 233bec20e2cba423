#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace mmgrasp::detail {

/// Of a point to a triangle.
inline double triangle_distance(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                const Eigen::Vector3d& c) {
  const auto to_segment = [&](const Eigen::Vector3d& u, const Eigen::Vector3d& v) {
    const Eigen::Vector3d uv = v - u;
    const double length = uv.squaredNorm();
    const double s = length > 0 ? std::clamp((p - u).dot(uv) / length, 0.0, 1.0) : 0;
    return (u + s * uv - p).norm();
  };
  const Eigen::Vector3d n = (b - a).cross(c - a);
  const bool over = n.dot((b - a).cross(p - a)) >= 0 && n.dot((c - b).cross(p - b)) >= 0 &&
                    n.dot((a - c).cross(p - c)) >= 0 && n.squaredNorm() > 0;
  if (over) return std::abs(n.dot(p - a)) / n.norm();
  return std::min({to_segment(a, b), to_segment(b, c), to_segment(c, a)});
}

}  // namespace mmgrasp::detail
