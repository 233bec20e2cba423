#include "grasp/synthesis/map_surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/geometry/mesh.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::Vector3d;

constexpr int kTurns = 90;                 // of the box, over a quarter turn
constexpr std::size_t kMostPoints = 2000;  // that the box is fitted to
constexpr double kNormalRadius = 0.006;    // over which normals are averaged [m]
constexpr int kLeastPiece = 50;            // vertices of the smallest body
constexpr std::size_t kLeastPoints = 10;   // fewer are no surface that a pad could meet

/// Mesh of the blocks above the table and, where the object's box is given, within a hand's reach of it.
SdfMesh surface_of(const ProbabilisticSdf& map, const SynthesisOptions& options) {
  if (!options.table && !options.object) return map.mesh();
  Eigen::AlignedBox3d within = map.bounds();
  if (within.isEmpty()) return map.mesh();
  if (options.object)
    within = within.intersection({options.object->min() - Vector3d::Constant(kHandReach),
                                  options.object->max() + Vector3d::Constant(kHandReach)});
  if (options.table) within.min().z() = std::max(within.min().z(), *options.table + options.table_tolerance);
  return map.mesh(within);
}

std::vector<Vector3d> vertex_normals(const TriangleMesh& mesh) {
  std::vector<Vector3d> normals(mesh.vertices.size(), Vector3d::Zero());
  for (const auto& [a, b, c] : mesh.triangles) {
    const Vector3d normal =
        (mesh.vertices[b] - mesh.vertices[a]).cross(mesh.vertices[c] - mesh.vertices[a]);  // twice the area long
    for (const int corner : {a, b, c}) normals[corner] += normal;
  }
  for (Vector3d& normal : normals)
    if (!normal.isZero(0)) normal.normalize();
  return normals;
}

/// Whether each vertex lies above the table, by more than it may be the table's, and in a piece of at least kLeastPiece
/// such vertices.
std::vector<char> in_bodies(const SdfMesh& found, const SynthesisOptions& options) {
  const TriangleMesh& mesh = *found.mesh;
  std::vector<int> parent(mesh.vertices.size()), size(mesh.vertices.size(), 0);
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  const auto above = [&](int i) {
    if (!options.table) return true;
    return mesh.vertices[i].z() >= *options.table + std::max(options.table_tolerance, options.sigmas * found.sigma[i]);
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    for (const auto& [from, to] : {std::pair{a, b}, {b, c}})
      if (above(from) && above(to)) parent[root(from)] = root(to);
  }
  for (std::size_t i = 0; i < parent.size(); ++i) ++size[root(static_cast<int>(i))];
  std::vector<char> in(parent.size());
  for (std::size_t i = 0; i < in.size(); ++i)
    in[i] = above(static_cast<int>(i)) && size[root(static_cast<int>(i))] >= kLeastPiece;
  return in;
}

}  // namespace

ObjectExtent fit_extent(const std::vector<Vector3d>& points, double floor) {
  const std::size_t stride = std::max<std::size_t>(1, points.size() / kMostPoints);
  double low = std::isnan(floor) ? kInfinity : floor, high = -kInfinity, least = kInfinity;
  for (const Vector3d& p : points) {
    low = std::min(low, p.z());
    high = std::max(high, p.z());
  }
  ObjectExtent best;
  for (int k = 0; k < kTurns; ++k) {
    const double angle = kPi / 2 * k / kTurns, c = std::cos(angle), s = std::sin(angle);
    double begin[2] = {kInfinity, kInfinity}, end[2] = {-kInfinity, -kInfinity};
    for (std::size_t i = 0; i < points.size(); i += stride) {
      const double at[2] = {c * points[i].x() + s * points[i].y(), c * points[i].y() - s * points[i].x()};
      for (int axis = 0; axis < 2; ++axis) {
        begin[axis] = std::min(begin[axis], at[axis]);
        end[axis] = std::max(end[axis], at[axis]);
      }
    }
    const double length = end[0] - begin[0], width = end[1] - begin[1];
    if (length * width >= least) continue;
    least = length * width;
    const double u = (begin[0] + end[0]) / 2, v = (begin[1] + end[1]) / 2;
    best.centre = Vector3d(c * u - s * v, s * u + c * v, (low + high) / 2);
    best.longest = std::max({length, width, high - low});
  }
  return best;
}

MapSurface::MapSurface(const ProbabilisticSdf& map, const SynthesisOptions& options) {
  const SdfMesh found = surface_of(map, options);
  const std::vector<Vector3d>& points = found.mesh->vertices;
  const bool whole = !options.table && !options.object;
  require(map.blocks() > 0 && !(whole && points.empty()), "map", std::to_string(map.frames()) + " frames",
          "has no surface to grasp: integrate depth images of the part first");
  const std::vector<Vector3d> normals = vertex_normals(*found.mesh);
  const std::vector<char> body = in_bodies(found, options);
  std::vector<std::size_t> chosen;
  Eigen::AlignedBox3d bounds;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!body[i]) continue;
    scene.push_back(points[i]);
    scene_normal.push_back(normals[i]);
    scene_sigma.push_back(found.sigma[i]);
    if ((options.object && !options.object->contains(points[i])) || normals[i].isZero(0)) continue;
    object.push_back(points[i]);
    object_normal.push_back(normals[i]);
    object_sigma.push_back(found.sigma[i]);
    bounds.extend(points[i]);
  }
  require(object.size() >= kLeastPoints,
          options.object  ? "object"
          : options.table ? "table"
                          : "map",
          std::to_string(object.size()) + " points", "is all of the map's surface that is left to grasp");
  grid_.emplace(object, kNormalRadius);
  extent = fit_extent(object, options.table.value_or(std::numeric_limits<double>::quiet_NaN()));
  diagonal = bounds.diagonal().norm();
}

Vector3d MapSurface::mean_normal(std::size_t i) const {
  Vector3d sum = Vector3d::Zero();
  const Vector3d reach = Vector3d::Constant(kNormalRadius);
  grid_->any_cell({object[i] - reach, object[i] + reach},
                  [&](const Vector3d&, std::uint32_t first, std::uint32_t last) {
                    for (std::uint32_t at = first; at < last; ++at) {
                      const std::uint32_t k = grid_->order()[at];
                      if ((object[k] - object[i]).squaredNorm() < kNormalRadius * kNormalRadius &&
                          object_normal[k].dot(object_normal[i]) > 0)
                        sum += object_normal[k];
                    }
                    return false;
                  });
  return sum.normalized();
}

}  // namespace mmgrasp::detail
