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
constexpr double kSamePlace = 1e-7;  // Hits nearer than this share of the body's size are one.

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

  const RayCaster caster(surface.mesh);
  const SurfacePoints points(surface.mesh);
  const double tolerance = kSamePlace * bounds.diagonal().norm();
  const double cone = std::atan(options.friction);
  const auto fits = [&](const ContactPair& pair) { return pair.width <= max_opening; };
  const int most = kMoreSamples * options.mesh_samples;
  std::size_t judged = 0;
  int fitting = 0;
  for (int i = 0; i < most && (i < options.mesh_samples || fitting < options.mesh_samples / kFew); ++i) {
    Rng rng(options.seed, static_cast<std::uint64_t>(i));
    const SurfacePoint start = points.draw(rng);
    const Eigen::Vector3d inward = -start.normal;
    // Along the normal the first contact is perfect; tilted lines also find wedges that need friction on both sides.
    const Eigen::Vector3d direction = i % 2 == 0 ? inward : sample_in_cone(inward, cone, rng);
    add_pairs_from(start, direction, caster, surface.solid, tolerance, cone, result.pairs);
    for (; judged < result.pairs.size(); ++judged) fitting += fits(result.pairs[judged]);
  }
  result.surface = std::move(surface);
  return result;
}

}  // namespace mmgrasp::detail
