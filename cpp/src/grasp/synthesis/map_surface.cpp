#include "grasp/synthesis/map_surface.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::Vector3d;

constexpr int kTurns = 90;                 // of the box, over a quarter turn
constexpr std::size_t kMostPoints = 2000;  // that the box is fitted to
constexpr std::size_t kLeastPoints = 10;   // fewer are no surface that a pad could meet

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
  const SdfPoints points = map.points();
  require(points.point.cols() > 0, "map", std::to_string(map.frames()) + " frames",
          "has no surface to grasp: integrate depth images of the part first");
  const double floor = options.table ? *options.table : std::numeric_limits<double>::quiet_NaN();
  Eigen::AlignedBox3d bounds;
  for (Eigen::Index i = 0; i < points.point.cols(); ++i) {
    const Vector3d p = points.point.col(i);
    if (options.table && p.z() < floor + options.table_tolerance) continue;
    scene.push_back(p);
    scene_sigma.push_back(points.sigma[i]);
    if ((options.object && !options.object->contains(p)) || points.normal.col(i).isZero(0)) continue;
    object.push_back(p);
    object_normal.push_back(points.normal.col(i));
    bounds.extend(p);
  }
  require(object.size() >= kLeastPoints, options.object ? "object" : "table",
          std::to_string(object.size()) + " points of the map's " + std::to_string(points.point.cols()),
          "leave no surface to grasp");
  extent = fit_extent(object, floor);
  diagonal = bounds.diagonal().norm();
}

}  // namespace mmgrasp::detail
