#include "geometry/triangle_tree.hpp"

#include <algorithm>
#include <numeric>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/geometry/detail/mesh_topology.hpp"
#include "mmgrasp/geometry/detail/triangle_distance.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::Vector3d;

constexpr int kLeaf = 4;

}  // namespace

TriangleTree::TriangleTree(const TriangleMesh& mesh) : mesh_(mesh), order_(mesh.triangles.size()) {
  std::iota(order_.begin(), order_.end(), 0);
  for (const auto& t : mesh.triangles)
    centres_.push_back((mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3);
  nodes_.reserve(2 * order_.size());
  if (!order_.empty()) build(0, static_cast<int>(order_.size()));
}

int TriangleTree::build(int begin, int end) {
  const int index = static_cast<int>(nodes_.size());
  nodes_.emplace_back();
  Eigen::AlignedBox3d box, centres;
  for (int i = begin; i < end; ++i) {
    for (const int corner : mesh_.triangles[order_[i]]) box.extend(mesh_.vertices[corner]);
    centres.extend(centres_[order_[i]]);
  }
  nodes_[index].box = box;
  nodes_[index].begin = begin;
  nodes_[index].end = end;
  if (end - begin <= kLeaf) return index;
  int axis = 0;
  centres.sizes().maxCoeff(&axis);
  const int middle = (begin + end) / 2;  // halves by count keep the depth logarithmic whatever the mesh
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end, [&](int a, int b) {
    return centres_[a][axis] != centres_[b][axis] ? centres_[a][axis] < centres_[b][axis] : a < b;
  });
  const int left = build(begin, middle), right = build(middle, end);
  nodes_[index].left = left;
  nodes_[index].right = right;
  return index;
}

double TriangleTree::distance(const Vector3d& point) const {
  double best = kInfinity;
  int stack[128];
  int size = 0;
  if (!nodes_.empty()) stack[size++] = 0;
  while (size > 0) {
    const Node& node = nodes_[stack[--size]];
    if (node.box.squaredExteriorDistance(point) >= best * best) continue;
    if (node.left < 0) {
      for (int i = node.begin; i < node.end; ++i) {
        const auto& t = mesh_.triangles[order_[i]];
        best =
            std::min(best, triangle_distance(point, mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]));
      }
      continue;
    }
    const bool left_nearer =
        nodes_[node.left].box.squaredExteriorDistance(point) < nodes_[node.right].box.squaredExteriorDistance(point);
    stack[size++] = left_nearer ? node.right : node.left;
    stack[size++] = left_nearer ? node.left : node.right;
  }
  return best;
}

bool TriangleTree::contains(const Vector3d& point) const {
  if (!mesh_.closed) return false;
  const Vector3d d = ray_direction();
  int winding = 0;
  int stack[128];
  int size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const Node& node = nodes_[stack[--size]];
    // The ray rises with slope 1 in z: where its height is within the box it must pass the box's x and y.
    const double low = std::max(node.box.min().z() - point.z(), 0.0), high = node.box.max().z() - point.z();
    if (high < 0) continue;
    bool passes = true;
    const double slack = 1e-9 * (1 + node.box.diagonal().norm() + high);
    for (int k = 0; k < 2; ++k) {
      const double from = point[k] + d[k] * low, to = point[k] + d[k] * high;  // d[k] > 0
      if (to < node.box.min()[k] - slack || from > node.box.max()[k] + slack) passes = false;
    }
    if (!passes) continue;
    if (node.left < 0) {
      for (int i = node.begin; i < node.end; ++i) {
        const auto& t = mesh_.triangles[order_[i]];
        winding +=
            ray_crossing(mesh_.vertices[t[0]] - point, mesh_.vertices[t[1]] - point, mesh_.vertices[t[2]] - point);
      }
      continue;
    }
    stack[size++] = node.left;
    stack[size++] = node.right;
  }
  return winding > 0;
}

}  // namespace mmgrasp::detail
