// load_mesh: the reader by the file's extension, scaling, cleaning.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>

#include "geometry/readers/mesh_readers.hpp"
#include "mmgrasp/core/detail/file_content.hpp"
#include "mmgrasp/core/limits.hpp"

namespace mmgrasp {

namespace {

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
                                                       const Eigen::Vector3d& scale, MeshReport* report,
                                                       MeshFaults* faults) {
  for (int k = 0; k < 3; ++k) {
    require_number(scale[k], "mesh scale of '" + path + "'");
    require(scale[k] != 0, "mesh scale of '" + path + "'", scale[k], "must be finite and not zero");
  }
  detail::RawMesh raw = read_mesh(path, content);
  if (raw.triangles.empty()) detail::mesh_error(path, "holds no triangle");
  for (std::size_t i = 0; i < raw.vertices.size(); ++i) {
    if (!raw.vertices[i].allFinite()) detail::mesh_error(path, "vertex " + std::to_string(i) + " is not finite");
    raw.vertices[i] = raw.vertices[i].cwiseProduct(scale);
    if (!(raw.vertices[i].cwiseAbs().maxCoeff() <= kLargestLength)) {
      detail::mesh_error(path, "vertex " + std::to_string(i) + " lies beyond 1e6 m (damaged?)");
    }
  }
  if (scale.prod() < 0) {  // A mirrored surface keeps its outside.
    for (auto& triangle : raw.triangles) std::swap(triangle[1], triangle[2]);
  }
  auto mesh = detail::clean_mesh(std::move(raw), path, report, faults);
  if (mesh->triangles.empty()) detail::mesh_error(path, "holds no triangle with an area");
  return mesh;
}

std::shared_ptr<const TriangleMesh> detail::load_mesh(const std::string& path, const Eigen::Vector3d& scale,
                                                      MeshFaults& faults) {
  return parse_mesh(path, file_content(path, "mesh file"), scale, nullptr, &faults);
}

std::shared_ptr<const TriangleMesh> load_mesh(const std::string& path, const Eigen::Vector3d& scale,
                                              MeshReport* report) {
  return detail::parse_mesh(path, detail::file_content(path, "mesh file"), scale, report);
}

}  // namespace mmgrasp
