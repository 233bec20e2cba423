#include "grasp/sampling/surface_points.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace mmgrasp::detail {

SurfacePoints::SurfacePoints(const TriangleMesh& mesh) {
  double area = 0;
  for (const auto& [i, j, k] : mesh.triangles) {
    Triangle t;
    t.a = mesh.vertices[i];
    t.ab = mesh.vertices[j] - t.a;
    t.ac = mesh.vertices[k] - t.a;
    const Eigen::Vector3d cross = t.ab.cross(t.ac);
    const double own = cross.norm() / 2;
    t.normal = cross / (2 * own);
    triangles_.push_back(t);
    cumulative_area_.push_back(area += own);
  }
}

SurfacePoint SurfacePoints::draw(Rng& rng) const {
  const double area = rng.uniform(0, cumulative_area_.back());
  const auto found = std::upper_bound(cumulative_area_.begin(), cumulative_area_.end(), area);
  const std::size_t index = std::min<std::size_t>(found - cumulative_area_.begin(), triangles_.size() - 1);
  const Triangle& triangle = triangles_[index];
  const double root = std::sqrt(rng.uniform()), v = rng.uniform();
  return {triangle.a + triangle.ab * (root * (1 - v)) + triangle.ac * (root * v), triangle.normal};
}

}  // namespace mmgrasp::detail
