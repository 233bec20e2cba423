// COLLADA files, read by assimp.
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <Eigen/Geometry>
#include <assimp/Importer.hpp>

#include "geometry/readers/mesh_readers.hpp"
#include "mmgrasp/geometry/detail/checked_dae.hpp"

namespace mmgrasp::detail {

namespace {

Eigen::Matrix4d to_eigen(const aiMatrix4x4& m) {
  Eigen::Matrix4d out;
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < 4; ++c) out(r, c) = m[r][c];
  }
  return out;
}

void add_node(const aiScene& scene, const aiNode& node, const Eigen::Matrix4d& T_parent, RawMesh& out) {
  const Eigen::Matrix4d T = T_parent * to_eigen(node.mTransformation);
  const bool mirrored = T.topLeftCorner<3, 3>().determinant() < 0;
  for (unsigned i = 0; i < node.mNumMeshes; ++i) {
    const aiMesh& mesh = *scene.mMeshes[node.mMeshes[i]];
    const int first = static_cast<int>(out.vertices.size());
    for (unsigned k = 0; k < mesh.mNumVertices; ++k) {
      const aiVector3D& v = mesh.mVertices[k];
      out.vertices.push_back((T * Eigen::Vector4d(v.x, v.y, v.z, 1)).head<3>());
    }
    for (unsigned k = 0; k < mesh.mNumFaces; ++k) {
      const aiFace& face = mesh.mFaces[k];
      if (face.mNumIndices != 3) continue;  // Points and lines have no surface.
      std::array<int, 3> triangle;
      for (int c = 0; c < 3; ++c) triangle[c] = first + static_cast<int>(face.mIndices[c]);
      if (mirrored) std::swap(triangle[1], triangle[2]);
      out.triangles.push_back(triangle);
    }
  }
  for (unsigned i = 0; i < node.mNumChildren; ++i) add_node(scene, *node.mChildren[i], T, out);
}

}  // namespace

RawMesh read_dae(const std::string& path, std::string_view content) {
  const std::string checked = checked_dae(path, content);
  Assimp::Importer importer;
  // URDF tools show DAE coordinates as they stand, whatever <up_axis> says; the unit scales the root node.
  importer.SetPropertyBool(AI_CONFIG_IMPORT_COLLADA_IGNORE_UP_DIRECTION, true);
  const aiScene* scene = importer.ReadFileFromMemory(checked.data(), checked.size(), aiProcess_Triangulate, "dae");
  if (scene == nullptr || scene->mRootNode == nullptr)
    mesh_error(path, std::string("no valid DAE: ") + importer.GetErrorString());
  RawMesh mesh;
  add_node(*scene, *scene->mRootNode, Eigen::Matrix4d::Identity(), mesh);
  return mesh;
}

}  // namespace mmgrasp::detail
