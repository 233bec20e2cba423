#pragma once

#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "mmgrasp/core/pose.hpp"
#include "mmgrasp/geometry/mesh.hpp"

namespace mmgrasp::test {

inline Pose at(double x, double y, double z) {
  Pose out = Pose::Identity();
  out.translation() << x, y, z;
  return out;
}

/// A box about the origin.
inline std::shared_ptr<const TriangleMesh> block(const Eigen::Vector3d& half) {
  std::vector<Eigen::Vector3d> corners;
  for (int i = 0; i < 8; ++i)
    corners.emplace_back(i & 1 ? half.x() : -half.x(), i & 2 ? half.y() : -half.y(), i & 4 ? half.z() : -half.z());
  return convex_hull(corners);
}

/// A closed profile of (radius, z), counter-clockwise, turned about z in 64 steps.
inline std::shared_ptr<const TriangleMesh> turned(const std::vector<std::pair<double, double>>& profile) {
  constexpr int kSides = 64;
  const int n = static_cast<int>(profile.size());
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<int, 3>> triangles;
  for (int i = 0; i < kSides; ++i)
    for (const auto& [r, z] : profile)
      vertices.emplace_back(r * std::cos(2 * M_PI * i / kSides), r * std::sin(2 * M_PI * i / kSides), z);
  for (int i = 0; i < kSides; ++i) {
    for (int k = 0; k < n; ++k) {
      const int a = n * i + k, b = n * i + (k + 1) % n, c = n * ((i + 1) % kSides) + k,
                d = n * ((i + 1) % kSides) + (k + 1) % n;
      triangles.push_back({a, c, b});
      triangles.push_back({b, c, d});
    }
  }
  return make_mesh(vertices, triangles);  // drops triangles on the axis
}

}  // namespace mmgrasp::test
