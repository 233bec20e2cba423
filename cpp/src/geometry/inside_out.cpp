#include "mmgrasp/geometry/detail/inside_out.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <utility>

#include "geometry/faces_inwards.hpp"

namespace mmgrasp::detail {

bool faces_inwards(const std::vector<Eigen::Vector3d>& vertices, const std::vector<std::array<int, 3>>& triangles) {
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& v : vertices) box.extend(v);
  if (box.isEmpty()) return false;
  const Eigen::Vector3d middle = box.center();
  double volume = 0, scale = 0;
  for (const auto& t : triangles) {
    const Eigen::Vector3d a = vertices[t[0]] - middle, b = vertices[t[1]] - middle;
    const double part = a.dot(b.cross(vertices[t[2]] - middle));
    volume += part;
    scale += std::abs(part);
  }
  return volume < -1e-9 * scale;
}

bool turn_outwards(TriangleMesh& mesh) {
  if (mesh.closed || !faces_inwards(mesh.vertices, mesh.triangles)) return false;
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return true;
}

std::shared_ptr<const TriangleMesh> turned_outwards(const std::shared_ptr<const TriangleMesh>& mesh) {
  if (mesh->closed || !faces_inwards(mesh->vertices, mesh->triangles)) return mesh;
  auto out = std::make_shared<TriangleMesh>(*mesh);
  turn_outwards(*out);
  return out;
}

}  // namespace mmgrasp::detail
