#include "mmgrasp/geometry/mesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <unordered_map>

#include "mmgrasp/geometry/detail/mesh_topology.hpp"
#include "mmgrasp/core/detail/file_content.hpp"
#include "geometry/readers/mesh_readers.hpp"

namespace mmgrasp {

namespace {

using Triangles = std::vector<std::array<int, 3>>;

struct VectorHash {
  std::size_t operator()(const Eigen::Vector3d& v) const {
    std::uint64_t hash = 0x9e3779b97f4a7c15ull;
    for (int k = 0; k < 3; ++k) {
      std::uint64_t bits;
      std::memcpy(&bits, &v[k], sizeof bits);
      hash = (hash ^ bits) * 0xff51afd7ed558ccdull;
      hash ^= hash >> 32;
    }
    return hash;
  }
};

// Lets equal vertices share an index; returns how many were removed.
int merge_vertices(std::vector<Eigen::Vector3d>& vertices, Triangles& triangles) {
  std::unordered_map<Eigen::Vector3d, int, VectorHash> index_of;
  std::vector<Eigen::Vector3d> kept;
  std::vector<int> new_index(vertices.size());
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Eigen::Vector3d v = vertices[i].array() + 0.0;  // -0 becomes 0, which hashes alike
    const auto [it, is_new] = index_of.emplace(v, static_cast<int>(kept.size()));
    if (is_new) kept.push_back(v);
    new_index[i] = it->second;
  }
  const int removed = static_cast<int>(vertices.size() - kept.size());
  for (auto& triangle : triangles) {
    for (int& corner : triangle) corner = new_index[corner];
  }
  vertices = std::move(kept);
  return removed;
}

void drop_unused_vertices(std::vector<Eigen::Vector3d>& vertices, Triangles& triangles) {
  std::vector<int> new_index(vertices.size(), -1);
  std::vector<Eigen::Vector3d> kept;
  for (auto& triangle : triangles) {
    for (int& corner : triangle) {
      if (new_index[corner] < 0) {
        new_index[corner] = static_cast<int>(kept.size());
        kept.push_back(vertices[corner]);
      }
      corner = new_index[corner];
    }
  }
  vertices = std::move(kept);
}

bool has_equal_corners(const std::array<int, 3>& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

bool has_no_area(const std::vector<Eigen::Vector3d>& v, const std::array<int, 3>& t) {
  const Eigen::Vector3d a = v[t[1]] - v[t[0]], b = v[t[2]] - v[t[0]], c = v[t[2]] - v[t[1]];
  const double longest = std::max({a.squaredNorm(), b.squaredNorm(), c.squaredNorm()});
  return a.cross(b).norm() <= 1e-14 * longest;
}

// The shared cleaning of files and arrays. Input is finite and its indices are in range.
std::shared_ptr<const TriangleMesh> clean_mesh(detail::RawMesh raw, const std::string& source, MeshReport* report) {
  MeshReport found;
  found.path = source;
  found.vertices_read = static_cast<int>(raw.vertices.size());
  const std::size_t triangles_read = raw.triangles.size();

  auto mesh = std::make_shared<TriangleMesh>();
  mesh->source = source;
  mesh->vertices = std::move(raw.vertices);
  mesh->triangles = std::move(raw.triangles);
  found.vertices_merged = merge_vertices(mesh->vertices, mesh->triangles);
  Triangles& triangles = mesh->triangles;
  triangles.erase(std::remove_if(triangles.begin(), triangles.end(), has_equal_corners), triangles.end());
  // Slivers without area may be what closes the mesh over a T-shaped seam, so they go only after the question is
  // answered.
  mesh->closed = detail::orient_closed(mesh->vertices, triangles);
  triangles.erase(
      std::remove_if(triangles.begin(), triangles.end(), [&](const auto& t) { return has_no_area(mesh->vertices, t); }),
      triangles.end());
  if (!mesh->closed) mesh->closed = detail::orient_closed(mesh->vertices, triangles);
  drop_unused_vertices(mesh->vertices, triangles);
  // Two coincident sheets are closed edge by edge but bound nothing.
  if (mesh->closed && !(mesh_volume(*mesh) > 0)) mesh->closed = false;
  if (mesh->closed && !triangles.empty()) mesh->convex = detail::is_convex(*mesh);

  found.degenerate_triangles = static_cast<int>(triangles_read - triangles.size());
  found.triangles = static_cast<int>(triangles.size());
  found.closed = mesh->closed;
  found.convex = mesh->convex;
  if (report != nullptr) *report = found;
  return mesh;
}

detail::RawMesh read_mesh(const std::string& path, std::string_view content) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  if (extension == ".stl") return detail::read_stl(path, content);
  if (extension == ".obj") return detail::read_obj(path, content);
  if (extension == ".ply") return detail::read_ply(path, content);
  if (extension == ".dae") return detail::read_dae(path, content);
  detail::mesh_error(path, "extension '" + extension + "' is none of .stl, .obj, .dae, .ply");
}

}  // namespace

std::shared_ptr<const TriangleMesh> detail::parse_mesh(const std::string& path, std::string_view content,
                                                       const Eigen::Vector3d& scale, MeshReport* report) {
  for (int k = 0; k < 3; ++k) {
    require(std::isfinite(scale[k]) && scale[k] != 0, "mesh scale of '" + path + "'", scale[k],
            "must be finite and not zero");
  }
  detail::RawMesh raw = read_mesh(path, content);
  if (raw.triangles.empty()) detail::mesh_error(path, "holds no triangle");
  for (std::size_t i = 0; i < raw.vertices.size(); ++i) {
    if (!raw.vertices[i].allFinite()) detail::mesh_error(path, "vertex " + std::to_string(i) + " is not finite");
    raw.vertices[i] = raw.vertices[i].cwiseProduct(scale);
    if (!(raw.vertices[i].cwiseAbs().maxCoeff() < 1e12)) {
      detail::mesh_error(path, "vertex " + std::to_string(i) + " lies beyond 1e12 m (damaged?)");
    }
  }
  if (scale.prod() < 0) {  // A mirrored surface keeps its outside.
    for (auto& triangle : raw.triangles) std::swap(triangle[1], triangle[2]);
  }
  auto mesh = clean_mesh(std::move(raw), path, report);
  if (mesh->triangles.empty()) detail::mesh_error(path, "holds no triangle with an area");
  return mesh;
}

std::shared_ptr<const TriangleMesh> load_mesh(const std::string& path, const Eigen::Vector3d& scale,
                                              MeshReport* report) {
  return detail::parse_mesh(path, detail::file_content(path, "mesh file"), scale, report);
}

std::shared_ptr<const TriangleMesh> make_mesh(std::vector<Eigen::Vector3d> vertices, Triangles triangles,
                                              const std::string& source, MeshReport* report) {
  const std::string name = source.empty() ? "mesh" : "mesh '" + source + "'";
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (!vertices[i].allFinite()) throw InvalidInput(name + ": vertex " + std::to_string(i) + " is not finite");
  }
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (const int corner : triangles[i]) {
      require(corner >= 0 && corner < static_cast<int>(vertices.size()),
              name + ": corner of triangle " + std::to_string(i), std::to_string(corner),
              "must be in [0, " + std::to_string(vertices.size()) + ")");
    }
  }
  auto mesh = clean_mesh({std::move(vertices), std::move(triangles)}, source, report);
  if (mesh->triangles.empty()) throw InvalidInput(name + ": holds no triangle with an area");
  return mesh;
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
