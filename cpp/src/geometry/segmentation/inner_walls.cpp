#include "geometry/segmentation/inner_walls.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "geometry/segmentation/alpha_expansion.hpp"
#include "geometry/segmentation/grow_regions.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/geometry/ray_caster.hpp"

namespace mmgrasp::detail {
namespace {

/// Where a ray begins, as a share of the mesh's size.
constexpr double kOffset = 1e-6;
/// What a border costs beside faces that disagree with their wall's other side: its length times the mesh's size by
/// this, against their area.
constexpr double kSmoothing = 0.02;
/// So much more a border costs in an edge that bends outwards by a right angle: the sides of a groove belong to the
/// walls that they meet there, though a ray through them may leave the solid in the next body but one.
constexpr double kOutwardEdge = 3;
/// More regions would make the cuts slow; their inner walls then grow from their borders alone.
constexpr int kMostRegions = 64;

}  // namespace

InnerWalls find_inner_walls(const FaceGraph& graph, int threads) {
  const RayCaster caster(graph.mesh());
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& v : graph.vertices) box.extend(v);
  const double offset = kOffset * box.diagonal().norm();
  InnerWalls out;
  out.inner.assign(graph.faces.size(), 0);
  out.opposite.assign(graph.faces.size(), -1);
  std::vector<Ray> rays;
  std::vector<int> faces;
  for (int f = 0; f < graph.size(); ++f) {
    if (graph.normals[f].isZero()) continue;
    faces.push_back(f);
    rays.push_back({graph.centres[f], graph.normals[f], offset});
    rays.push_back({graph.centres[f], -graph.normals[f], offset});
  }
  const std::vector<RayHit> hits = caster.closest_hits(rays, threads);
  for (std::size_t k = 0; k < faces.size(); ++k) {
    const RayHit &outward = hits[2 * k], &inward = hits[2 * k + 1];
    out.inner[faces[k]] = outward && outward.front;
    if (inward && !inward.front) out.opposite[faces[k]] = inward.triangle;
  }
  return out;
}

void label_inner_walls(const FaceGraph& graph, const InnerWalls& walls, int count, std::vector<int>& labels) {
  const std::vector<char> all(graph.faces.size(), 1);
  if (count < 1) return;
  if (count > 1 && count <= kMostRegions) {
    std::vector<int> node(graph.faces.size(), -1), face_of;
    for (int f = 0; f < graph.size(); ++f) {
      if (labels[f] >= 0) continue;
      node[f] = static_cast<int>(face_of.size());
      face_of.push_back(f);
    }
    Eigen::MatrixXd costs = Eigen::MatrixXd::Zero(count, static_cast<Eigen::Index>(face_of.size()));
    for (std::size_t k = 0; k < face_of.size(); ++k) {
      const int behind = walls.opposite[face_of[k]];
      if (behind < 0 || labels[behind] < 0) continue;
      costs.col(static_cast<Eigen::Index>(k)).setConstant(graph.areas[face_of[k]]);
      costs(labels[behind], static_cast<Eigen::Index>(k)) = 0;
    }
    std::vector<LabelLink> links;
    const double scale = kSmoothing * std::sqrt(graph.area);
    for (const FaceBorder& border : graph.borders) {
      const int a = node[border.first], b = node[border.second];
      const double outward = std::clamp(border.bend / (kPi / 2), 0.0, 1.0);
      const double cost = scale * (1 + kOutwardEdge * outward) * border.length;
      if (a >= 0 && b >= 0) {
        links.push_back({a, b, cost});
      } else if ((a >= 0) != (b >= 0)) {
        const int inside = a >= 0 ? a : b, label = labels[a >= 0 ? border.second : border.first];
        costs.col(inside).array() += cost;
        costs(label, inside) -= cost;
      }
    }
    const std::vector<int> found = alpha_expansion(costs, links);
    for (std::size_t k = 0; k < face_of.size(); ++k) labels[face_of[k]] = found[k];
  }
  grow_regions(graph, all, labels);
}

}  // namespace mmgrasp::detail
