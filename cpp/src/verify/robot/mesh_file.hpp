#pragma once

#include <Eigen/Core>
#include <map>
#include <memory>
#include <string>
#include <tuple>

#include "mmgrasp/geometry/mesh.hpp"

namespace mmgrasp::verify::detail {

/// Mesh files read by assimp, each once a scale. Vertices are rounded to float, as assimp keeps them.
class MeshFiles {
 public:
  /// Throws InvalidInput naming the file and assimp's reason.
  std::shared_ptr<const TriangleMesh> read(const std::string& path, const Eigen::Vector3d& scale);

 private:
  std::map<std::tuple<std::string, double, double, double>, std::shared_ptr<const TriangleMesh>> meshes_;
};

}  // namespace mmgrasp::verify::detail
