#include "mmgrasp/geometry/planar_facets.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/geometry/detail/faces_or_all.hpp"

namespace mmgrasp {
namespace {

Eigen::Vector3d scaled_normal(const TriangleMesh& mesh, int face) {
  const auto& t = mesh.triangles[face];
  const Eigen::Vector3d& a = mesh.vertices[t[0]];
  return (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a) / 2;
}

/// Faces that share an edge with each of `faces`, among them.
std::map<int, std::vector<int>> neighbours(const TriangleMesh& mesh, const std::vector<int>& faces) {
  std::map<std::pair<int, int>, std::vector<int>> of_edge;
  detail::InterruptionPoll poll(256);
  for (const int f : faces) {
    poll();
    const auto& t = mesh.triangles[f];
    for (int i = 0; i < 3; ++i) of_edge[std::minmax(t[i], t[(i + 1) % 3])].push_back(f);
  }
  std::map<int, std::vector<int>> out;
  for (const auto& [edge, sharing] : of_edge) {
    poll();
    for (const int f : sharing) {
      for (const int g : sharing) {
        if (f != g) out[f].push_back(g);
      }
    }
  }
  return out;
}

}  // namespace

std::vector<Facet> planar_facets(const TriangleMesh& mesh, const std::vector<int>& faces, double angle) {
  require(angle > 0 && angle <= 0.5, "angle", angle, "must be in (0, 0.5] [rad]");
  std::vector<int> order = detail::faces_or_all(mesh, faces);
  const auto beside = neighbours(mesh, order);
  detail::InterruptionPoll poll(1024);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    poll();
    return scaled_normal(mesh, a).squaredNorm() > scaled_normal(mesh, b).squaredNorm();
  });
  std::vector<char> taken(mesh.triangles.size(), false);
  std::vector<Facet> out;
  for (const int seed : order) {
    if (taken[seed] || scaled_normal(mesh, seed).norm() == 0) continue;
    const Eigen::Vector3d normal = scaled_normal(mesh, seed).normalized();
    Facet facet;
    facet.faces = {seed};
    taken[seed] = true;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < facet.faces.size(); ++i) {
      poll();
      const int face = facet.faces[i];
      const Eigen::Vector3d scaled = scaled_normal(mesh, face);
      const auto& t = mesh.triangles[face];
      sum += scaled;
      facet.area += scaled.norm();
      facet.centre += scaled.norm() * (mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3;
      const auto found = beside.find(face);
      if (found == beside.end()) continue;
      for (const int next : found->second) {
        const Eigen::Vector3d n = scaled_normal(mesh, next);
        if (taken[next] || n.dot(normal) < std::cos(angle) * n.norm()) continue;
        taken[next] = true;
        facet.faces.push_back(next);
      }
    }
    facet.normal = sum.normalized();
    facet.centre /= facet.area;
    std::sort(facet.faces.begin(), facet.faces.end());
    out.push_back(std::move(facet));
  }
  std::stable_sort(out.begin(), out.end(), [](const Facet& a, const Facet& b) { return a.area > b.area; });
  return out;
}

}  // namespace mmgrasp
