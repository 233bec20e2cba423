#include "mmgrasp/grasp/contact_patch.hpp"

#include <Eigen/Eigenvalues>
#include <cmath>
#include <string>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/core/random.hpp"

namespace mmgrasp {
namespace {

using Eigen::Vector3d;

constexpr int kTriples = 40;  // planes tried through three hits

struct FittedPlane {
  Vector3d middle = Vector3d::Zero(), normal = Vector3d::UnitZ();
  double distance(const Vector3d& p) const { return std::abs(normal.dot(p - middle)); }
};

/// Least squares: the direction in which the points spread least.
FittedPlane fit_plane(const std::vector<Vector3d>& points) {
  FittedPlane plane;
  for (const Vector3d& p : points) plane.middle += p / static_cast<double>(points.size());
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Vector3d& p : points) spread += (p - plane.middle) * (p - plane.middle).transpose();
  plane.normal = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(0);
  return plane;
}

std::vector<std::size_t> inliers_of(const FittedPlane& plane, const std::vector<Vector3d>& points, double tolerance) {
  std::vector<std::size_t> inliers;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (plane.distance(points[i]) <= tolerance) inliers.push_back(i);
  return inliers;
}

FittedPlane fit_to(const std::vector<Vector3d>& points, const std::vector<std::size_t>& chosen) {
  std::vector<Vector3d> some;
  some.reserve(chosen.size());
  for (const std::size_t i : chosen) some.push_back(points[i]);
  return fit_plane(some);
}

/// The inliers of the plane that holds most points; of equal ones the first tried.
std::vector<std::size_t> most_inliers(const std::vector<Vector3d>& points, double tolerance) {
  std::vector<std::size_t> best = inliers_of(fit_plane(points), points, tolerance);
  if (best.size() == points.size()) return best;
  Rng rng(1);  // the same triples for every pad: the answer depends on the hits alone
  for (int k = 0; k < kTriples; ++k) {
    const Vector3d &a = points[rng.index(points.size())], &b = points[rng.index(points.size())],
                   &c = points[rng.index(points.size())];
    FittedPlane plane{a, (b - a).cross(c - a)};
    const double area = plane.normal.norm();
    if (area < 1e-9) continue;
    plane.normal /= area;
    std::vector<std::size_t> inliers = inliers_of(plane, points, tolerance);
    if (inliers.size() <= best.size()) continue;
    // The plane of all of them holds no fewer as a rule; where it does, it is not taken.
    std::vector<std::size_t> again = inliers_of(fit_to(points, inliers), points, tolerance);
    best = again.size() >= inliers.size() ? std::move(again) : std::move(inliers);
  }
  return best;
}

}  // namespace

void ContactPatchOptions::check() const {
  require(rays >= 2 && rays <= 50, "rays", rays, "must be from 2 to 50");
  require(min_hits > 0 && min_hits <= 1, "min_hits", min_hits, "must be above 0 and at most 1");
  require(min_inliers > 0 && min_inliers <= 1, "min_inliers", min_inliers, "must be above 0 and at most 1");
  require_positive(plane_tolerance, "plane_tolerance", "m");
}

PadRays pad_rays(const FingerPad& pad, const Pose& T_world_hand, const ContactPatchOptions& options) {
  const int n = options.rays;
  const Pose T = T_world_hand * pad.T_hand_pad;
  PadRays rays;
  rays.origins.resize(3, n * n);
  rays.directions = T.linear().col(2).replicate(1, n * n);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      const double x = ((i + 0.5) / n - 0.5) * pad.depth, y = ((j + 0.5) / n - 0.5) * pad.width;
      rays.origins.col(i * n + j) = T * Vector3d(x, y, 0);
    }
  }
  return rays;
}

PatchState fit_contact_patch(const SdfHits& hits, const Vector3d& pad_normal, double reach, ContactPatch& patch,
                             const ContactPatchOptions& options) {
  std::vector<Vector3d> points;
  std::vector<Eigen::Index> rays;
  patch.pad_normal = pad_normal;
  patch.nearest = detail::kInfinity;
  for (Eigen::Index i = 0; i < hits.distance.size(); ++i) {
    if (!hits.hit[i] || hits.distance[i] > reach) continue;
    points.push_back(hits.point.col(i));
    rays.push_back(i);
    patch.nearest = std::min(patch.nearest, hits.distance[i]);
  }
  patch.hits = hits.distance.size() > 0 ? static_cast<double>(points.size()) / hits.distance.size() : 0;
  if (points.size() < 3 || patch.hits < options.min_hits) return PatchState::missed;
  const std::vector<std::size_t> inliers = most_inliers(points, options.plane_tolerance);
  patch.inliers = static_cast<double>(inliers.size()) / static_cast<double>(points.size());
  if (inliers.size() < 3 || patch.inliers < options.min_inliers) return PatchState::uneven;
  const FittedPlane plane = fit_to(points, inliers);
  patch.point = plane.middle;
  patch.normal = plane.normal.dot(pad_normal) > 0 ? Vector3d(-plane.normal) : plane.normal;
  patch.distance = patch.sigma = 0;
  for (const std::size_t i : inliers) {
    patch.distance += hits.distance[rays[i]] / static_cast<double>(inliers.size());
    patch.sigma += hits.sigma[rays[i]] / static_cast<double>(inliers.size());
  }
  return PatchState::found;
}

}  // namespace mmgrasp
