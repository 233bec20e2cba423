// Contact pairs of meshes, by rays along the inward normals.
#include <algorithm>
#include <cmath>

#include "grasp/sampling/contact_pairs.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/geometry/ray_caster.hpp"

namespace mmgrasp::detail {
namespace {

struct Triangle {
  Eigen::Vector3d a, ab, ac, normal;  ///< normal: unit, by the winding.
  double area = 0;
};

/// All shapes of the object as one heap of triangles in the object frame.
struct Surface {
  std::vector<Triangle> triangles;
  TriangleMesh mesh;  ///< The same triangles, for the ray caster.
  std::vector<double> cumulative_area;
  Eigen::AlignedBox3d bounds;
  Eigen::Vector3d centre_of_mass = Eigen::Vector3d::Zero();
  bool solid = true;     ///< Every shape is closed: the union's inside is well defined.
  double tolerance = 0;  ///< Below this two hits are the same place [m].
};

/// Centre of volume for solids (shapes that overlap count twice there), of area for open surfaces.
Eigen::Vector3d centre_of(const Surface& surface) {
  Eigen::Vector3d weighted = Eigen::Vector3d::Zero();
  double total = 0;
  const Eigen::Vector3d origin = surface.bounds.center();
  for (const Triangle& t : surface.triangles) {
    const Eigen::Vector3d corners = 3 * (t.a - origin) + t.ab + t.ac;
    const double weight = surface.solid ? (t.a - origin).dot(t.ab.cross(t.ac)) / 6 : t.area;
    weighted += weight * corners / (surface.solid ? 4 : 3);
    total += weight;
  }
  return std::abs(total) > 1e-15 ? Eigen::Vector3d(origin + weighted / total) : origin;
}

Surface gather(const std::vector<LinkShape>& object) {
  Surface surface;
  double area = 0;
  for (const LinkShape& shape : object) {
    const auto mesh = shape_mesh(shape.shape);
    surface.solid = surface.solid && mesh->closed;
    const int first = static_cast<int>(surface.mesh.vertices.size());
    for (const Eigen::Vector3d& v : mesh->vertices) surface.mesh.vertices.push_back(shape.T_link_shape * v);
    for (const auto& [i, j, k] : mesh->triangles) {
      Triangle t;
      t.a = shape.T_link_shape * mesh->vertices[i];
      t.ab = shape.T_link_shape * mesh->vertices[j] - t.a;
      t.ac = shape.T_link_shape * mesh->vertices[k] - t.a;
      const Eigen::Vector3d cross = t.ab.cross(t.ac);
      t.area = cross.norm() / 2;
      if (t.area <= 0) continue;
      t.normal = cross / (2 * t.area);
      surface.triangles.push_back(t);
      surface.mesh.triangles.push_back({first + i, first + j, first + k});
      surface.cumulative_area.push_back(area += t.area);
      for (const Eigen::Vector3d& corner : {t.a, Eigen::Vector3d(t.a + t.ab), Eigen::Vector3d(t.a + t.ac)})
        surface.bounds.extend(corner);
    }
  }
  if (surface.triangles.empty()) return surface;
  surface.tolerance = 1e-7 * surface.bounds.diagonal().norm();
  surface.centre_of_mass = centre_of(surface);
  return surface;
}

/// Hits at which the line leaves the union of solids, when it enters that union at t = 0; none when the start is buried
/// in another shape, or when a shape is not what it says and entries and exits do not balance.
std::vector<RayHit> solid_exits(const std::vector<RayHit>& hits, double tolerance) {
  std::vector<RayHit> exits;
  bool entered_at_start = false;
  int depth = 0;
  for (std::size_t i = 0; i < hits.size();) {
    const double t = hits[i].distance;
    const int before = depth;
    const RayHit* exit = nullptr;
    for (; i < hits.size() && hits[i].distance - t <= tolerance; ++i) {
      if (!hits[i].front) exit = &hits[i];
      depth += hits[i].front ? 1 : -1;
    }
    if (depth < 0) return {};
    if (before == 0 && depth > 0 && std::abs(t) <= tolerance) entered_at_start = true;
    if (before > 0 && depth == 0 && t > tolerance && exit) exits.push_back(*exit);
  }
  if (depth != 0 || !entered_at_start) exits.clear();
  return exits;
}

/// On open surfaces there is no inside: every other hit is an opposite wall.
std::vector<RayHit> other_hits(const std::vector<RayHit>& hits, double tolerance) {
  std::vector<RayHit> others;
  for (const RayHit& hit : hits)
    if (std::abs(hit.distance) > tolerance) others.push_back(hit);
  return others;
}

struct SurfacePoint {
  Eigen::Vector3d point;
  const Triangle* triangle;
};

SurfacePoint sample_point(const Surface& surface, Rng& rng) {
  const double area = rng.uniform(0, surface.cumulative_area.back());
  const auto found = std::upper_bound(surface.cumulative_area.begin(), surface.cumulative_area.end(), area);
  const std::size_t index =
      std::min<std::size_t>(found - surface.cumulative_area.begin(), surface.triangles.size() - 1);
  const Triangle& triangle = surface.triangles[index];
  const double root = std::sqrt(rng.uniform()), v = rng.uniform();
  return {triangle.a + triangle.ab * (root * (1 - v)) + triangle.ac * (root * v), &triangle};
}

/// Uniform over the cone of directions around `axis`.
Eigen::Vector3d sample_in_cone(const Eigen::Vector3d& axis, double half_angle, Rng& rng) {
  const double cosine = rng.uniform(std::cos(half_angle), 1), sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  const double around = rng.uniform(0, kTwoPi);
  const Eigen::Vector3d u = orthogonal_to(axis), v = axis.cross(u);
  return (cosine * axis + sine * (std::cos(around) * u + std::sin(around) * v)).normalized();
}

/// Angle between two lines [rad], in [0, pi / 2].
double line_angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), std::abs(a.dot(b)));
}

void add_pairs_from(const SurfacePoint& start, const Eigen::Vector3d& direction, const Surface& surface,
                    const RayCaster& caster, double cone, std::vector<ContactPair>& pairs) {
  const double start_angle = line_angle(direction, start.triangle->normal);
  if (start_angle > cone) return;
  const std::vector<RayHit> hits = caster.all_hits({start.point, direction, -kInfinity});  // the whole line
  const std::vector<RayHit> ends =
      surface.solid ? solid_exits(hits, surface.tolerance) : other_hits(hits, surface.tolerance);
  for (const RayHit& end : ends) {
    const double end_angle = line_angle(direction, end.normal);
    if (end_angle > cone) continue;
    ContactPair pair;
    pair.middle = start.point + direction * (end.distance / 2);
    pair.axis = direction;
    pair.width = std::abs(end.distance);
    pair.alignment = 1 - std::max(start_angle, end_angle) / cone;
    pair.first_approach = orthogonal_to(direction);
    pairs.push_back(pair);
  }
}

}  // namespace

ContactPairs surface_pairs(const std::vector<LinkShape>& object, const GraspSamplerOptions& options) {
  const Surface surface = gather(object);
  ContactPairs result;
  if (surface.triangles.empty()) return result;
  result.centre_of_mass = surface.centre_of_mass;
  for (int i = 0; i < 8; ++i)
    result.corners.push_back(surface.bounds.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i)));

  const RayCaster caster(surface.mesh);
  const double cone = std::atan(options.friction);
  for (int i = 0; i < options.mesh_samples; ++i) {
    Rng rng(options.seed, static_cast<std::uint64_t>(i));
    const SurfacePoint start = sample_point(surface, rng);
    const Eigen::Vector3d inward = -start.triangle->normal;
    // Along the normal the first contact is perfect; tilted lines also find wedges that need friction on both sides.
    const Eigen::Vector3d direction = i % 2 == 0 ? inward : sample_in_cone(inward, cone, rng);
    add_pairs_from(start, direction, surface, caster, cone, result.pairs);
  }
  return result;
}

}  // namespace mmgrasp::detail
