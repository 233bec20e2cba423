#pragma once

#include <Eigen/Core>
#include <vector>

namespace mmgrasp::detail {

/// n . (x, y) <= d.
struct HalfPlane {
  Eigen::Vector2d n;
  double d;
};

/// The part of a convex polygon over a half-plane of its x and y (Sutherland and Hodgman 1974).
inline std::vector<Eigen::Vector3d> clip_polygon(const std::vector<Eigen::Vector3d>& polygon, const HalfPlane& half) {
  std::vector<Eigen::Vector3d> out;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector3d &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double da = half.n.dot(a.head<2>()) - half.d, db = half.n.dot(b.head<2>()) - half.d;
    if (da <= 0) out.push_back(a);
    if ((da < 0 && db > 0) || (da > 0 && db < 0)) out.push_back(a + da / (da - db) * (b - a));
  }
  return out;
}

}  // namespace mmgrasp::detail
