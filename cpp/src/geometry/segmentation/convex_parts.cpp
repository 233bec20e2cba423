#include "geometry/segmentation/convex_parts.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/geometry/mesh.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::Vector3d;
constexpr int kSamples = 512;
/// Flatter regions have no volume, as a share of their size.
constexpr double kFlat = 1e-4;
/// More points are thinned to the extreme ones in this many directions.
constexpr std::size_t kMostPoints = 2000;

/// The points that are farthest in some of many directions: their hull misses less than 1e-3 of the radius.
std::vector<Vector3d> extreme_points(const std::vector<Vector3d>& points) {
  if (points.size() <= kMostPoints) return points;
  std::vector<char> taken(points.size(), 0);
  const double golden = 2.39996322972865332;
  const int directions = static_cast<int>(kMostPoints) / 2;
  Eigen::Matrix3Xd all(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) all.col(static_cast<Eigen::Index>(i)) = points[i];
  for (int k = 0; k < directions; ++k) {
    const double z = 1 - (2.0 * k + 1) / directions, r = std::sqrt(1 - z * z);
    const Vector3d d(r * std::cos(golden * k), r * std::sin(golden * k), z);
    Eigen::Index at;
    (d.transpose() * all).maxCoeff(&at);
    taken[at] = 1;
  }
  std::vector<Vector3d> out;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (taken[i]) out.push_back(points[i]);
  }
  return out;
}

bool is_flat(const std::vector<Vector3d>& points) {
  if (points.size() < 4) return true;
  Vector3d mean = Vector3d::Zero();
  for (const Vector3d& p : points) mean += p / static_cast<double>(points.size());
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const Vector3d& p : points) scatter += (p - mean) * (p - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scatter);
  return solver.eigenvalues()[0] <= kFlat * kFlat * solver.eigenvalues()[2];
}

double halton(int index, int base) {
  double out = 0, share = 1;
  for (int i = index; i > 0; i /= base) {
    share /= base;
    out += share * (i % base);
  }
  return out;
}

}  // namespace

bool RegionHull::contains(const Vector3d& x, double tolerance) const {
  for (const Eigen::Vector4d& plane : planes) {
    if (plane.head<3>().dot(x) > plane.w() + tolerance) return false;
  }
  return !planes.empty();
}

RegionHull region_hull(const std::vector<Vector3d>& given) {
  RegionHull out;
  const std::vector<Vector3d> points = extreme_points(given);
  if (is_flat(points)) {
    out.points = points;
    return out;
  }
  std::shared_ptr<const TriangleMesh> hull;
  try {
    hull = convex_hull(points);
  } catch (const InvalidInput&) {  // flat after all
    out.points = points;
    return out;
  }
  out.points = hull->vertices;
  out.triangles = hull->triangles;
  out.volume = mesh_volume(*hull);
  for (const auto& t : hull->triangles) {
    const Vector3d a = hull->vertices[t[0]];
    const Vector3d n = (hull->vertices[t[1]] - a).cross(hull->vertices[t[2]] - a).normalized();
    if (!n.isZero() && n.allFinite()) out.planes.emplace_back(n.x(), n.y(), n.z(), n.dot(a));
  }
  return out;
}

double uncovered_volume(const RegionHull& a, const RegionHull& b, RegionHull* joined) {
  std::vector<Vector3d> points = a.points;
  points.insert(points.end(), b.points.begin(), b.points.end());
  const RegionHull hull = region_hull(points);
  if (joined) *joined = hull;
  if (hull.volume <= 0) return 0;
  Vector3d middle = Vector3d::Zero();
  for (const Vector3d& p : hull.points) middle += p / static_cast<double>(hull.points.size());
  std::vector<double> sums;
  double total = 0;
  for (const auto& t : hull.triangles) {
    const Vector3d u = hull.points[t[0]] - middle, v = hull.points[t[1]] - middle, w = hull.points[t[2]] - middle;
    total += std::max(0.0, u.dot(v.cross(w)));
    sums.push_back(total);
  }
  const double tolerance = 1e-6 * std::cbrt(hull.volume);
  int outside = 0;
  for (int k = 0; k < kSamples; ++k) {
    const double at = (k + 0.5) / kSamples * total;
    const std::size_t t =
        std::min<std::size_t>(sums.size() - 1, std::upper_bound(sums.begin(), sums.end(), at) - sums.begin());
    const Vector3d u = hull.points[hull.triangles[t][0]], v = hull.points[hull.triangles[t][1]],
                   w = hull.points[hull.triangles[t][2]];
    // Even over the triangle, and by the cube root towards it.
    const double s = std::sqrt(halton(k + 1, 2)), r = halton(k + 1, 3), deep = std::cbrt(halton(k + 1, 5));
    const Vector3d x = middle + deep * ((1 - s) * u + s * (1 - r) * v + s * r * w - middle);
    outside += !a.contains(x, tolerance) && !b.contains(x, tolerance);
  }
  return hull.volume * outside / kSamples;
}

}  // namespace mmgrasp::detail
