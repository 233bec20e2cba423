#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "mmgrasp/geometry/mesh.hpp"

namespace mmgrasp::detail {

/// Bounding boxes over a mesh's triangles, for distances from its surface and the question of inside or outside.
class TriangleTree {
 public:
  /// Keeps a reference to the mesh.
  explicit TriangleTree(const TriangleMesh& mesh);

  /// Distance from the surface.
  double distance(const Eigen::Vector3d& point) const;
  /// As mesh_contains(): never inside an open mesh.
  bool contains(const Eigen::Vector3d& point) const;

 private:
  struct Node {
    Eigen::AlignedBox3d box;
    int left = -1, right = -1;  // children; -1 for a leaf
    int begin = 0, end = 0;     // triangles of a leaf
  };

  int build(int begin, int end);

  const TriangleMesh& mesh_;
  std::vector<int> order_;
  std::vector<Eigen::Vector3d> centres_;
  std::vector<Node> nodes_;
};

}  // namespace mmgrasp::detail
