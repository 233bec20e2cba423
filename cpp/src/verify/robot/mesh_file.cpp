#include "verify/robot/mesh_file.hpp"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <array>
#include <assimp/Importer.hpp>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <utility>
#include <vector>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/geometry/detail/checked_dae.hpp"

namespace mmgrasp::verify::detail {
namespace {

struct Triangles {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::array<int, 3>> corners;
};

void add_node(const aiScene& scene, const aiNode& node, const aiMatrix4x4& T_file_parent, const Eigen::Vector3d& scale,
              Triangles& out) {
  const aiMatrix4x4 T = T_file_parent * node.mTransformation;
  const bool mirrored = T.Determinant() * scale.prod() < 0;  // the outside stays outside
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    const aiMesh& mesh = *scene.mMeshes[node.mMeshes[i]];
    const int first = static_cast<int>(out.vertices.size());
    for (unsigned k = 0; k < mesh.mNumVertices; ++k) {
      const aiVector3D v = T * mesh.mVertices[k];
      out.vertices.push_back(scale.cwiseProduct(Eigen::Vector3d(v.x, v.y, v.z)));
    }
    for (unsigned k = 0; k < mesh.mNumFaces; ++k) {
      const aiFace& face = mesh.mFaces[k];
      if (face.mNumIndices != 3) continue;  // points and lines
      std::array<int, 3> corners;
      for (int c = 0; c < 3; ++c) corners[c] = first + static_cast<int>(face.mIndices[c]);
      if (mirrored) std::swap(corners[1], corners[2]);
      out.corners.push_back(corners);
    }
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) add_node(scene, *node.mChildren[i], T, scale, out);
}

/// Assimp ends the process when it is to cut such a face into triangles.
bool has_empty_face(const aiScene& scene) {
  for (unsigned i = 0; i < scene.mNumMeshes; ++i) {
    const aiMesh& mesh = *scene.mMeshes[i];
    for (unsigned k = 0; k < mesh.mNumFaces; ++k)
      if (mesh.mFaces[k].mNumIndices == 0) return true;
  }
  return false;
}

bool is_dae(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return extension == ".dae";
}

std::string content_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::shared_ptr<const TriangleMesh> read_mesh(const std::string& path, const Eigen::Vector3d& scale) {
  Assimp::Importer importer;
  // URDF tools show DAE coordinates as they stand, whatever <up_axis> says.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const aiScene* scene = nullptr;
  if (is_dae(path)) {
    const std::string text = mmgrasp::detail::checked_dae(path, content_of(path));
    scene = importer.ReadFileFromMemory(text.data(), text.size(), 0, "dae");
  } else {
    scene = importer.ReadFile(path, 0);
  }
  if (scene && has_empty_face(*scene)) throw InvalidInput("mesh file '" + path + "': has a face without corners");
  if (scene) scene = importer.ApplyPostProcessing(aiProcess_Triangulate);
  if (!scene || !scene->mRootNode)
    throw InvalidInput("mesh file '" + path + "': assimp refuses it: " + importer.GetErrorString());
  Triangles triangles;
  add_node(*scene, *scene->mRootNode, aiMatrix4x4(), scale, triangles);
  if (triangles.corners.empty()) throw InvalidInput("mesh file '" + path + "': assimp finds no triangle in it");
  return make_mesh(std::move(triangles.vertices), std::move(triangles.corners), path);
}

}  // namespace

std::shared_ptr<const TriangleMesh> MeshFiles::read(const std::string& path, const Eigen::Vector3d& scale) {
  std::shared_ptr<const TriangleMesh>& mesh = meshes_[{path, scale.x(), scale.y(), scale.z()}];
  if (!mesh) mesh = read_mesh(path, scale);
  return mesh;
}

}  // namespace mmgrasp::verify::detail
