#include "mapping/segmentation/supporting_plane.hpp"

#include <algorithm>
#include <cmath>

#include "mapping/pcl_segmentation.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::Vector3d;

/// `found` turned to the side that is up, or nothing when most points lie below it.
std::optional<SupportingPlane> upward(const FoundPlane& found, const std::vector<Vector3d>& points,
                                      const ObjectSegmentationOptions& options, const Vector3d& eye) {
  std::ptrdiff_t positive = 0, negative = 0;
  for (const Vector3d& p : points) {
    const double height = found.normal.dot(p) - found.offset;
    positive += height > options.plane_tolerance;
    negative += height < -options.plane_tolerance;
  }
  double side = static_cast<double>(positive - negative);
  if (!options.up.isZero()) {
    side = found.normal.dot(options.up);
  } else if (positive == negative) {
    side = found.normal.dot(eye) - found.offset;
  }
  if (side < 0) {
    if (negative < positive) return std::nullopt;
    return SupportingPlane{-found.normal, -found.offset};
  }
  if (positive < negative) return std::nullopt;
  return SupportingPlane{found.normal, found.offset};
}

}  // namespace

std::optional<SupportingPlane> find_supporting_plane(const std::vector<Vector3d>& points,
                                                     const ObjectSegmentationOptions& options, const Vector3d& eye) {
  std::vector<Vector3d> rest = points;
  while (true) {
    const FoundPlane found =
        dominant_plane(rest, options.plane_tolerance, options.plane_iterations, options.up, options.up_angle);
    if (!found.found || found.inliers.size() < options.min_plane_share * points.size()) return std::nullopt;
    if (const auto plane = upward(found, points, options, eye)) return plane;
    std::vector<char> taken(rest.size(), 0);
    for (const int i : found.inliers) taken[i] = 1;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < rest.size(); ++i) {
      if (!taken[i]) rest[kept++] = rest[i];
    }
    rest.resize(kept);
  }
}

}  // namespace mmgrasp::detail
