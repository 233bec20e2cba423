#include "mmgrasp/geometry/mesh.hpp"

#include <Eigen/Geometry>

#include "geometry/mesh_cleaning.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/geometry/detail/mesh_topology.hpp"

namespace mmgrasp {

namespace {

std::shared_ptr<const TriangleMesh> checked_and_cleaned(std::vector<Eigen::Vector3d> vertices,
                                                        std::vector<std::array<int, 3>> triangles,
                                                        const std::string& source, MeshReport* report,
                                                        detail::MeshFaults* faults) {
  const std::string name = source.empty() ? "mesh" : "mesh '" + source + "'";
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (!vertices[i].allFinite()) throw InvalidInput(name + ": vertex " + std::to_string(i) + " is not finite");
    if (vertices[i].cwiseAbs().maxCoeff() > kLargestLength)
      require_position(vertices[i], name + ": vertex " + std::to_string(i));
  }
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (const int corner : triangles[i]) {
      require(corner >= 0 && corner < static_cast<int>(vertices.size()),
              name + ": corner of triangle " + std::to_string(i), std::to_string(corner),
              "must be in [0, " + std::to_string(vertices.size()) + ")");
    }
  }
  auto mesh = detail::clean_mesh({std::move(vertices), std::move(triangles)}, source, report, faults);
  if (mesh->triangles.empty()) throw InvalidInput(name + ": holds no triangle with an area");
  return mesh;
}

}  // namespace

std::shared_ptr<const TriangleMesh> make_mesh(std::vector<Eigen::Vector3d> vertices,
                                              std::vector<std::array<int, 3>> triangles, const std::string& source,
                                              MeshReport* report) {
  return checked_and_cleaned(std::move(vertices), std::move(triangles), source, report, nullptr);
}

std::shared_ptr<const TriangleMesh> detail::make_mesh(std::vector<Eigen::Vector3d> vertices,
                                                      std::vector<std::array<int, 3>> triangles, MeshFaults& faults) {
  return checked_and_cleaned(std::move(vertices), std::move(triangles), "", nullptr, &faults);
}

double mesh_volume(const TriangleMesh& mesh) {
  if (mesh.vertices.empty()) return 0;
  // Measured from a vertex of its own: less cancellation far from the origin.
  const Eigen::Vector3d origin = mesh.vertices[0];
  double six = 0;
  for (const auto& t : mesh.triangles) {
    six += (mesh.vertices[t[0]] - origin).dot((mesh.vertices[t[1]] - origin).cross(mesh.vertices[t[2]] - origin));
  }
  return six / 6;
}

bool mesh_contains(const TriangleMesh& mesh, const Eigen::Vector3d& point) {
  if (!mesh.closed) return false;
  int winding = 0;
  for (const auto& t : mesh.triangles) {
    winding +=
        detail::ray_crossing(mesh.vertices[t[0]] - point, mesh.vertices[t[1]] - point, mesh.vertices[t[2]] - point);
  }
  return winding > 0;
}

}  // namespace mmgrasp
