#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "geometry/hierarchy/ray_kernels.hpp"
#include "mmgrasp/geometry/mesh.hpp"

namespace mmgrasp::detail {

/// The point of a triangle that is nearest to p.
Eigen::Vector3d closest_on_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                    const Eigen::Vector3d& c);
/// The triangle nearest to a point.
struct NearestTriangle {
  double distance;  ///< Infinite for an empty mesh.
  int triangle = -1, packet = -1, lane = -1;
};

/// Bounding-volume hierarchy over a mesh's triangles: rays, distances and the question of inside or outside. Eight
/// children a node, up to four triangles a leaf, split where the surface-area heuristic says.
class TriangleTree {
 public:
  explicit TriangleTree(const TriangleMesh& mesh);

  /// Distance from the surface; infinite for an empty mesh.
  double distance(const Eigen::Vector3d& point) const { return nearest(point).distance; }
  /// The triangle nearest to a point; where several are equally near, the one with the least index.
  NearestTriangle nearest(const Eigen::Vector3d& point) const;
  /// As mesh_contains(): never inside an open mesh.
  bool contains(const Eigen::Vector3d& point) const;

  bool empty() const { return packets_.empty(); }
  bool closed() const { return closed_; }
  TreeView view() const { return {nodes_.data(), packets_.data()}; }
  const TrianglePacket& packet(int index) const { return packets_[index]; }
  Eigen::Vector3d corner(int packet, int lane, int which) const {
    const auto& c = packets_[packet].corner[which];
    return {c[0][lane], c[1][lane], c[2][lane]};
  }
  /// Box around every corner [m].
  const Eigen::AlignedBox3d& bounds() const { return bounds_; }

  /// False: the ray, as far as it is to be followed, misses the tree's box.
  bool prepare(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction, double nearest, double farthest,
               PreparedRay& ray) const {
    return !empty() && ray_kernels().prepare(place_, origin.data(), direction.data(), nearest, farthest, ray);
  }

  /// Calls visit(packet) for each leaf whose box the ray meets.
  template <class Visit>
  void visit_leaves(const PreparedRay& ray, Visit&& visit) const {
    ray_kernels().leaves(
        view(), ray, [](void* data, int packet) { (*static_cast<Visit*>(data))(packet); }, &visit);
  }

 private:
  friend class TreeBuilder;
  bool closed_;
  Eigen::AlignedBox3d bounds_;
  Eigen::Vector3d centre_ = Eigen::Vector3d::Zero();
  double scale_ = 1;  // of the tree's coordinates: (p - centre) * scale
  TreePlace place_{};
  std::vector<TreeNode> nodes_;
  std::vector<TrianglePacket> packets_;
};

}  // namespace mmgrasp::detail
