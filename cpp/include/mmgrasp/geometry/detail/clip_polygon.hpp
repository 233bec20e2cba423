#pragma once

#include <Eigen/Core>
#include <vector>

#include "mmgrasp/geometry/detail/mesh_topology.hpp"

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

/// Area of a convex polygon's shadow in x and y; positive when it turns counter-clockwise.
inline double shadow_area(const std::vector<Eigen::Vector3d>& polygon) {
  double area = 0;
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
    area += edge_side((polygon[i] - polygon[0]).head<2>(), (polygon[i + 1] - polygon[0]).head<2>()) / 2;
  return area;
}

}  // namespace mmgrasp::detail
