#include "mmgrasp/mapping/fit_cuboids.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "mapping/pcl_segmentation.hpp"
#include "mapping/plane_frame.hpp"
#include "mapping/top_rectangle.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"

namespace mmgrasp {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
constexpr double kHalfPi = 1.57079632679489661923;

void check_tray(const KnownTray& tray) {
  checked_pose(tray.T_world_tray.matrix(), "tray.T_world_tray");
  for (int k = 0; k < 3; ++k) require_length(tray.size[k], "tray.size");
  require_not_negative(tray.wall, "tray.wall", "m");
  require(2 * tray.wall < tray.size.head<2>().minCoeff(), "tray.wall", tray.wall, "must leave room between the walls");
}

/// Takes plane and tray out of a cloud, divides the rest into clusters and fits an upright cuboid to each.
class CuboidFitter {
 public:
  CuboidFitter(const std::vector<Vector3d>& points, const CuboidFitOptions& options, const Vector3d& eye)
      : points_(points), options_(options), eye_(eye) {
    fit_.labels.assign(points.size(), -2);
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (!points[i].allFinite()) continue;
      if (points[i].cwiseAbs().maxCoeff() > kLargestLength)
        require_position(points[i], "points[" + std::to_string(i) + "]");
      measured_.push_back(static_cast<int>(i));
    }
  }

  CuboidFit fit(const std::optional<KnownTray>& tray) {
    std::vector<int> above;
    if (tray) {
      above = above_tray_floor(*tray);
    } else {
      above = above_dominant_plane();
    }
    fit_clusters(above);
    return std::move(fit_);
  }

 private:
  void set_plane(const Vector3d& normal, double offset) {
    fit_.plane_found = true;
    fit_.plane_normal = normal;
    fit_.plane_offset = offset;
    T_world_plane_ = detail::plane_frame(normal, offset);
    T_plane_world_ = T_world_plane_.inverse(Eigen::Isometry);
  }

  std::vector<int> above_tray_floor(const KnownTray& tray) {
    const Vector3d up = tray.T_world_tray.linear().col(2);
    set_plane(up, up.dot(tray.T_world_tray.translation()));
    const Pose T_tray_world = tray.T_world_tray.inverse(Eigen::Isometry);
    const Vector2d inner = tray.size.head<2>() / 2 - Vector2d::Constant(tray.wall + options_.wall_margin);
    std::vector<int> above;
    for (const int i : measured_) {
      const Vector3d p = T_tray_world * points_[i];
      if (std::abs(p.x()) > inner.x() || std::abs(p.y()) > inner.y()) continue;
      sort_by_height(i, p.z(), above);
    }
    return above;
  }

  /// The plane's points themselves or what is above it.
  void sort_by_height(int i, double height, std::vector<int>& above) {
    if (std::abs(height) <= options_.plane_tolerance) {
      fit_.labels[i] = -1;
    } else if (height > 0 && height <= options_.max_height) {
      above.push_back(i);
    }
  }

  std::vector<int> above_dominant_plane() {
    std::vector<Vector3d> measured;
    for (const int i : measured_) measured.push_back(points_[i]);
    const detail::FoundPlane plane = detail::dominant_plane(measured, options_.plane_tolerance,
                                                            options_.plane_iterations, options_.up, options_.up_angle);
    if (!plane.found) return {};
    const double side = options_.up.isZero() ? plane.normal.dot(eye_) - plane.offset : plane.normal.dot(options_.up);
    set_plane(side < 0 ? Vector3d(-plane.normal) : plane.normal, side < 0 ? -plane.offset : plane.offset);
    std::vector<Vector2d> on_plane;
    for (const int i : plane.inliers) on_plane.push_back((T_plane_world_ * measured[i]).head<2>());
    const std::vector<Vector2d> hull = detail::hull_of(std::move(on_plane));
    std::vector<int> above;
    for (const int i : measured_) {
      const Vector3d p = T_plane_world_ * points_[i];
      if (detail::inside_hull(hull, p.head<2>())) sort_by_height(i, p.z(), above);
    }
    return above;
  }

  void fit_clusters(const std::vector<int>& above) {
    std::vector<Vector3d> standing;
    for (const int i : above) standing.push_back(T_plane_world_ * points_[i]);
    for (const auto& cluster :
         detail::euclidean_clusters(standing, options_.cluster_tolerance, options_.leaf, options_.min_points)) {
      FittedCuboid cuboid;
      if (!fit_cluster(standing, cluster, cuboid)) continue;
      for (const int k : cluster) fit_.labels[above[k]] = static_cast<int>(fit_.cuboids.size());
      fit_.cuboids.push_back(cuboid);
    }
  }

  bool fit_cluster(const std::vector<Vector3d>& standing, const std::vector<int>& cluster, FittedCuboid& out) const {
    const double band = options_.plane_tolerance / 2;
    std::vector<double> heights;
    for (const int k : cluster) heights.push_back(standing[k].z());
    double top = quantile(heights, 0.95);
    std::vector<double> near_top;
    for (const double h : heights) {
      if (std::abs(h - top) <= band) near_top.push_back(h);
    }
    top = quantile(near_top, 0.5);
    detail::FacePoints face;
    const Vector3d eye = T_plane_world_ * eye_;
    for (const int k : cluster) {
      const Vector3d& p = standing[k];
      if (std::abs(p.z() - top) > band) continue;
      face.points.push_back(p.head<2>());
      // A pixel stands for an area that grows with the square of the distance and with the slant.
      const Vector3d ray = p - eye;
      face.weights.push_back(ray.z() < -1e-6 ? ray.squaredNorm() * ray.norm() / -ray.z() : 1.0);
    }
    if (face.points.size() < 8) return false;
    detail::Rectangle box = detail::fit_rectangle(face, 2 * options_.leaf);
    if (!(box.size.minCoeff() > 0)) return false;
    if (box.size.y() > box.size.x()) {
      std::swap(box.size.x(), box.size.y());
      box.angle += kHalfPi;
    }
    Pose T_plane_box = Pose::Identity();
    T_plane_box.linear() = Eigen::AngleAxisd(box.angle, Vector3d::UnitZ()).toRotationMatrix();
    T_plane_box.translation() << box.centre, top / 2;
    out.T_world_box = T_world_plane_ * T_plane_box;
    out.size << box.size, top;
    out.points = static_cast<int>(cluster.size());
    out.fill = box.fill;
    return true;
  }

  static double quantile(std::vector<double>& values, double share) {
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * (values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at;
  }

  const std::vector<Vector3d>& points_;
  const CuboidFitOptions& options_;
  Vector3d eye_;
  std::vector<int> measured_;
  Pose T_world_plane_ = Pose::Identity(), T_plane_world_ = Pose::Identity();
  CuboidFit fit_;
};

}  // namespace

void CuboidFitOptions::check() const {
  require_length(plane_tolerance, "plane_tolerance");
  require_not_negative(wall_margin, "wall_margin", "m");
  require_numbers(up, "up");
  require(up_angle > 0 && up_angle <= kHalfPi, "up_angle", up_angle, "must be above 0 and at most pi/2 [rad]");
  require_length(max_height, "max_height");
  require_length(cluster_tolerance, "cluster_tolerance");
  require_length(leaf, "leaf");
  require(leaf < cluster_tolerance, "leaf", leaf,
          "must be less than cluster_tolerance, " + std::to_string(cluster_tolerance));
  require_count(min_points, "min_points", 8);
  require_within(plane_iterations, 1, 1e6, "plane_iterations", "");
}

CuboidFit fit_cuboids(const std::vector<Vector3d>& points, const CuboidFitOptions& options,
                      const std::optional<KnownTray>& tray, const Vector3d& eye) {
  options.check();
  if (tray) check_tray(*tray);
  require_numbers(eye, "eye", "m");
  return CuboidFitter(points, options, eye).fit(tray);
}

}  // namespace mmgrasp
