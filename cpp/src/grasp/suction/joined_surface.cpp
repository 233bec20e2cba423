#include "mmgrasp/grasp/detail/joined_surface.hpp"

#include <Eigen/Geometry>
#include <cmath>

#include "mmgrasp/core/error.hpp"

namespace mmgrasp::detail {
namespace {

Eigen::Vector3d centre_of(const TriangleMesh& mesh, bool solid) {
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& vertex : mesh.vertices) bounds.extend(vertex);
  const Eigen::Vector3d origin = bounds.center();
  Eigen::Vector3d weighted = Eigen::Vector3d::Zero();
  double total = 0;
  for (const auto& [i, j, k] : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices[i] - origin;
    const Eigen::Vector3d ab = mesh.vertices[j] - mesh.vertices[i], ac = mesh.vertices[k] - mesh.vertices[i];
    const double weight = solid ? a.dot(ab.cross(ac)) / 6 : ab.cross(ac).norm() / 2;
    weighted += weight * (3 * a + ab + ac) / (solid ? 4 : 3);
    total += weight;
  }
  return std::abs(total) > 1e-15 ? Eigen::Vector3d(origin + weighted / total) : origin;
}

}  // namespace

void check_object(const std::vector<LinkShape>& object) {
  require(!object.empty(), "object", "no shapes", "an object to grasp needs at least one shape");
  for (std::size_t i = 0; i < object.size(); ++i) {
    const std::string field = "object.shapes[" + std::to_string(i) + "]";
    require(!std::holds_alternative<Plane>(object[i].shape), field, "plane", "a plane cannot be grasped");
    check_shape(object[i].shape, field);
    checked_pose(object[i].T_link_shape.matrix(), field + ".pose");
  }
}

JoinedSurface joined_surface(const std::vector<LinkShape>& object, int segments) {
  JoinedSurface joined;
  for (const LinkShape& shape : object) {
    const auto mesh = shape_mesh(shape.shape, segments);
    joined.solid = joined.solid && mesh->closed;
    const int first = static_cast<int>(joined.mesh.vertices.size());
    for (const Eigen::Vector3d& v : mesh->vertices) joined.mesh.vertices.push_back(shape.T_link_shape * v);
    for (const auto& [i, j, k] : mesh->triangles) {
      const Eigen::Vector3d& a = joined.mesh.vertices[first + i];
      const Eigen::Vector3d cross = (joined.mesh.vertices[first + j] - a).cross(joined.mesh.vertices[first + k] - a);
      if (cross.norm() > 0) joined.mesh.triangles.push_back({first + i, first + j, first + k});
    }
  }
  joined.centre_of_mass = centre_of(joined.mesh, joined.solid);
  return joined;
}

}  // namespace mmgrasp::detail
