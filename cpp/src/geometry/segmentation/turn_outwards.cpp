#include "geometry/segmentation/turn_outwards.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <utility>

namespace mmgrasp::detail {

bool turn_outwards(TriangleMesh& mesh) {
  if (mesh.closed) return false;
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& v : mesh.vertices) box.extend(v);
  if (box.isEmpty()) return false;
  const Eigen::Vector3d middle = box.center();
  double volume = 0, scale = 0;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices[t[0]] - middle, b = mesh.vertices[t[1]] - middle;
    const double part = a.dot(b.cross(mesh.vertices[t[2]] - middle));
    volume += part;
    scale += std::abs(part);
  }
  if (volume >= -1e-9 * scale) return false;  // a flat sheet has no volume
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return true;
}

}  // namespace mmgrasp::detail
