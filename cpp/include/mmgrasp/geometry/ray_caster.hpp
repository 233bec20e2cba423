#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <vector>

#include "mmgrasp/core/export.hpp"
#include "mmgrasp/geometry/mesh.hpp"

namespace mmgrasp {

namespace detail {
class TriangleTree;
}

/// The points origin + t * direction with nearest <= t <= farthest. Lengths along it are multiples of the direction's
/// length: metres when the direction is a unit vector.
struct MMGRASP_EXPORT Ray {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();      ///< [m]
  Eigen::Vector3d direction = Eigen::Vector3d::UnitX();  ///< Not zero; need not be a unit vector.
  double nearest = 0;  ///< A ray that starts on the surface meets it at about 0; start later to leave that out.
  double farthest = std::numeric_limits<double>::infinity();  ///< Infinite, and nearest = -infinity: the line.
};

/// Where a ray meets a mesh.
struct MMGRASP_EXPORT RayHit {
  int triangle = -1;   ///< Index in the mesh; -1: the ray meets nothing, and the other fields mean nothing.
  bool front = false;  ///< Met on the side that the normal points to: of a closed mesh the ray enters the solid.
  double distance =
      std::numeric_limits<double>::infinity();      ///< Distance along the ray, in multiples of the direction's length.
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< origin + distance * direction [m].
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();  ///< The triangle's unit normal, by its winding.
  explicit operator bool() const { return triangle >= 0; }
};

/// Casts rays against the triangles of a mesh through a bounding-volume hierarchy, in double precision.
///
/// Triangles are met from both sides. Watertight: neighbours judge a shared edge by the same numbers (Woop, Benthin and
/// Wald 2013), so a ray through an edge or a corner of a closed mesh never slips through. A triangle seen exactly
/// edge-on is not met itself; its neighbours are. Answers do not depend on threads or on the machine's instruction set.
///
///     const RayCaster caster(*load_mesh("cup.stl"));
///     if (const RayHit hit = caster.closest_hit({eye, direction})) use(hit.point, hit.normal);
///
/// Keeps a copy of the triangles, so the mesh may go. Const members may be called from several threads at once. Origins
/// may lie outside the mesh by up to a million times its size. Every cast throws InvalidInput on an origin or direction
/// that is not finite, or a direction of zero.
class MMGRASP_EXPORT RayCaster {
 public:
  /// Any triangles, also none; those without an area are never met.
  explicit RayCaster(const TriangleMesh& mesh);

  /// The first triangle along the ray; of several at the same distance the one with the least index.
  RayHit closest_hit(const Ray& ray) const;
  /// Whether the ray meets anything; quicker than closest_hit().
  bool any_hit(const Ray& ray) const;
  /// Every crossing of the surface, by distance, then by index. A surface that is crossed at a shared edge or corner is
  /// counted once, so that for a closed mesh entries and exits along the whole line balance.
  std::vector<RayHit> all_hits(const Ray& ray) const;
  /// As mesh_contains(): inside a closed mesh; never inside an open one.
  bool contains(const Eigen::Vector3d& point) const;

  /// closest_hit() of each ray; `threads` = 0 means all.
  std::vector<RayHit> closest_hits(const std::vector<Ray>& rays, int threads = 1) const;
  /// The same into a vector that may be kept from one batch to the next, which saves its memory's first touch.
  void closest_hits(const std::vector<Ray>& rays, std::vector<RayHit>& hits, int threads = 1) const;
  /// any_hit() of each ray, 1 or 0.
  std::vector<char> any_hits(const std::vector<Ray>& rays, int threads = 1) const;

 private:
  std::shared_ptr<const detail::TriangleTree> tree_;
};

}  // namespace mmgrasp
