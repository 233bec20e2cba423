// Contact pairs of meshes, by rays along the inward normals.
#include <algorithm>
#include <cmath>

#include "grasp/sampling/contact_pairs.hpp"
#include "grasp/sampling/surface_points.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/geometry/ray_caster.hpp"
#include "mmgrasp/grasp/detail/joined_surface.hpp"

namespace mmgrasp::detail {
namespace {

constexpr int kMoreSamples = 8;  // So many times the samples are drawn at most, of a body that the hand can take at few
constexpr int kFew = 4;          // places: fewer than one in so many samples.
constexpr double kAsStraight = 0.02;  // Alignments that differ by less are as good.
constexpr double kAlong = 1e-6;       // Lines that are so nearly along the approach [rad] are not across it.
constexpr double kSamePlace = 1e-7;   // Hits nearer than this share of the body's size are one.

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

/// Uniform over the cone of directions around `axis`.
Eigen::Vector3d sample_in_cone(const Eigen::Vector3d& axis, double half_angle, Rng& rng) {
  const double cosine = rng.uniform(std::cos(half_angle), 1), sine = std::sqrt(std::max(0.0, 1 - cosine * cosine));
  const double around = rng.uniform(0, kTwoPi);
  const Eigen::Vector3d u = orthogonal_to(axis), v = axis.cross(u);
  return (cosine * axis + sine * (std::cos(around) * u + std::sin(around) * v)).normalized();
}

/// A line along which hands that come from the wanted direction may close: the part of it across that. Zero: none of it
/// is.
Eigen::Vector3d across_approach(const Eigen::Vector3d& line, const GraspSamplerOptions& options) {
  if (!options.approach_direction) return line;
  const Eigen::Vector3d wanted = options.approach_direction->normalized();
  const Eigen::Vector3d across = line - wanted.dot(line) * wanted;
  return across.norm() > kAlong ? Eigen::Vector3d(across.normalized()) : Eigen::Vector3d::Zero();
}

/// Angle between two lines [rad], in [0, pi / 2].
double line_angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), std::abs(a.dot(b)));
}

void add_pairs_from(const SurfacePoint& start, const Eigen::Vector3d& direction, const RayCaster& caster, bool solid,
                    double tolerance, double cone, std::vector<ContactPair>& pairs) {
  const double start_angle = line_angle(direction, start.normal);
  if (start_angle > cone) return;
  const std::vector<RayHit> hits = caster.all_hits({start.point, direction, -kInfinity});  // the whole line
  const std::vector<RayHit> ends = solid ? solid_exits(hits, tolerance) : other_hits(hits, tolerance);
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

/// Draws points of a surface and looks for their opposites: `samples` of them, and up to `most` while few of the pairs
/// are no wider than max_opening.
void draw_pairs(const TriangleMesh& mesh, bool solid, double tolerance, double max_opening, int samples, int most,
                const GraspSamplerOptions& options, std::vector<ContactPair>& pairs) {
  const RayCaster caster(mesh);
  const SurfacePoints points(mesh);
  const double cone = std::atan(options.friction);
  std::size_t judged = pairs.size();
  int fitting = 0;
  for (int i = 0; i < most && (i < samples || fitting < samples / kFew); ++i) {
    Rng rng(options.seed, static_cast<std::uint64_t>(i));
    const SurfacePoint start = points.draw(rng);
    const Eigen::Vector3d inward = -start.normal;
    // Along the normal the first contact is perfect; tilted lines also find wedges that need friction on both sides.
    const Eigen::Vector3d drawn = i % 2 == 0 ? inward : sample_in_cone(inward, cone, rng);
    const Eigen::Vector3d direction = across_approach(drawn, options);
    if (direction.isZero(0)) continue;
    add_pairs_from(start, direction, caster, solid, tolerance, cone, pairs);
    for (; judged < pairs.size(); ++judged) fitting += pairs[judged].width <= max_opening;
  }
}

/// Whether the surface stands at least as straight across the pair's line as the hull's contacts do, outermost.
bool is_straighter(const RayCaster& surface, const ContactPair& pair, double cone) {
  const std::vector<RayHit> hits = surface.all_hits({pair.middle, pair.axis, -kInfinity});
  if (hits.empty()) return true;
  const double angle = std::max(line_angle(pair.axis, hits.front().normal), line_angle(pair.axis, hits.back().normal));
  return 1 - angle / cone >= pair.alignment - kAsStraight;
}

/// Pairs on the hull of a surface, where flat pads may stand on edges of it: its faces are drawn by themselves.
void draw_hull_pairs(const TriangleMesh& hull, const TriangleMesh& surface, double tolerance, double max_opening,
                     const GraspSamplerOptions& options, std::vector<ContactPair>& pairs) {
  std::vector<ContactPair> drawn;
  draw_pairs(hull, true, tolerance, max_opening, options.mesh_samples, options.mesh_samples, options, drawn);
  const RayCaster caster(surface);
  const double cone = std::atan(options.friction);
  for (const ContactPair& pair : drawn)
    if (!is_straighter(caster, pair, cone)) pairs.push_back(pair);
}

bool is_convex(const std::vector<LinkShape>& object) {
  return object.size() == 1 && shape_mesh(object.front().shape)->convex;
}

}  // namespace

ContactPairs surface_pairs(const std::vector<LinkShape>& object, double max_opening,
                           const GraspSamplerOptions& options) {
  JoinedSurface surface = joined_surface(object);
  ContactPairs result;
  if (surface.mesh.triangles.empty()) return result;
  result.centre_of_mass = surface.centre_of_mass;
  Eigen::AlignedBox3d bounds;
  for (const Eigen::Vector3d& vertex : surface.mesh.vertices) bounds.extend(vertex);
  for (int i = 0; i < 8; ++i) result.corners.push_back(bounds.corner(static_cast<Eigen::AlignedBox3d::CornerType>(i)));

  const double tolerance = kSamePlace * bounds.diagonal().norm();
  const int samples = options.mesh_samples;
  draw_pairs(surface.mesh, surface.solid, tolerance, max_opening, samples, kMoreSamples * samples, options,
             result.pairs);
  if (surface.solid && !is_convex(object)) {
    result.hull = convex_hull(surface.mesh.vertices);
    draw_hull_pairs(*result.hull, surface.mesh, tolerance, max_opening, options, result.pairs);
  }
  result.surface = std::move(surface);
  return result;
}

}  // namespace mmgrasp::detail
