#include "geometry/hierarchy/triangle_tree.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/hierarchy/tree_builder.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/geometry/detail/mesh_topology.hpp"
#include "mmgrasp/geometry/detail/triangle_distance.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::Vector3d;

Vector3d closest_on_segment(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  const Vector3d ab = b - a;
  const double length = ab.squaredNorm();
  const double s = length > 0 ? std::clamp((p - a).dot(ab) / length, 0.0, 1.0) : 0.0;
  return a + s * ab;
}

// Whether the foot of p on the triangle's plane, whose normal is n, lies inside the triangle.
bool above_inside(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& n) {
  return n.dot((b - a).cross(p - a)) >= 0 && n.dot((c - b).cross(p - b)) >= 0 && n.dot((a - c).cross(p - c)) >= 0;
}

}  // namespace

Vector3d closest_on_triangle(const Vector3d& p, const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector3d n = (b - a).cross(c - a);
  const double area = n.squaredNorm();
  if (area > 0 && above_inside(p, a, b, c, n)) return p - n * (n.dot(p - a) / area);
  const Vector3d edges[3] = {closest_on_segment(p, a, b), closest_on_segment(p, b, c), closest_on_segment(p, c, a)};
  return *std::min_element(edges, edges + 3, [&](const Vector3d& s, const Vector3d& t) {
    return (p - s).squaredNorm() < (p - t).squaredNorm();
  });
}

TriangleTree::TriangleTree(const TriangleMesh& mesh) : closed_(mesh.closed) {
  for (const auto& t : mesh.triangles)
    for (const int corner : t) bounds_.extend(mesh.vertices[corner]);
  if (mesh.triangles.empty()) return;
  centre_ = bounds_.center();
  const double half = 0.5 * bounds_.sizes().maxCoeff();
  scale_ = half > 0 ? 1 / half : 1;
  for (int k = 0; k < 3; ++k) {
    place_.lower[k] = bounds_.min()[k] - 1e-6 / scale_;
    place_.upper[k] = bounds_.max()[k] + 1e-6 / scale_;
    place_.centre[k] = centre_[k];
  }
  place_.scale = scale_;
  TreeBuilder(*this, mesh);
}

NearestTriangle TriangleTree::nearest(const Vector3d& point) const {
  NearestTriangle best{kInfinity};
  if (empty()) return best;
  // Squares must stay finite; a point moved nearer makes boxes nearer, which is safe.
  const Eigen::Vector3f from = ((point - centre_) * scale_).cwiseMax(-1e15).cwiseMin(1e15).cast<float>();
  // A box's distance from far away has the rounding of its coordinates, which this factor covers; near by the boxes'
  // own margin does.
  const auto bound = [&](double distance) {
    const double length = distance * scale_ * (1 + 1e-5);
    return length < 1e18 ? static_cast<float>(length * length) : std::numeric_limits<float>::max();
  };
  float allowed = bound(kInfinity);
  struct Pending {
    int child;
    float squared;
  } stack[kStackSize];
  int size = 0;
  stack[size++] = {0, 0};
  while (size > 0) {
    const Pending at = stack[--size];
    if (at.squared > allowed) continue;
    if (at.child < 0) {
      for (int lane = 0; lane < kPacketWidth; ++lane) {
        const int triangle = packets_[~at.child].triangle[lane];
        if (triangle < 0) continue;
        const double distance = triangle_distance(point, corner(~at.child, lane, 0), corner(~at.child, lane, 1),
                                                  corner(~at.child, lane, 2));
        if (distance > best.distance || (distance == best.distance && triangle > best.triangle)) continue;
        best = {distance, triangle, ~at.child, lane};
        allowed = bound(distance);
      }
      continue;
    }
    const TreeNode& node = nodes_[at.child];
    float squared[kTreeWidth];
    for (int i = 0; i < kTreeWidth; ++i) {
      float sum = 0;
      for (int k = 0; k < 3; ++k) {
        const float beyond = std::max(std::max(node.bounds[k][i] - from[k], from[k] - node.bounds[3 + k][i]), 0.0f);
        sum += beyond * beyond;
      }
      squared[i] = sum;
    }
    const int bottom = size;
    for (int i = 0; i < kTreeWidth; ++i) {
      if (!(squared[i] <= allowed)) continue;
      int place = size++;
      for (; place > bottom && stack[place - 1].squared < squared[i]; --place) stack[place] = stack[place - 1];
      stack[place] = {node.child[i], squared[i]};
    }
  }
  return best;
}

bool TriangleTree::contains(const Vector3d& point) const {
  PreparedRay ray;
  if (!closed_ || !prepare(point, ray_direction(), 0, kInfinity, ray)) return false;
  int winding = 0;
  visit_leaves(ray, [&](int packet) {
    for (int lane = 0; lane < kPacketWidth; ++lane) {
      if (packets_[packet].triangle[lane] < 0) continue;
      winding += ray_crossing(corner(packet, lane, 0) - point, corner(packet, lane, 1) - point,
                              corner(packet, lane, 2) - point);
    }
  });
  return winding > 0;
}

}  // namespace mmgrasp::detail
