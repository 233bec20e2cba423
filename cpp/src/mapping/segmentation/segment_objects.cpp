#include "mmgrasp/mapping/segment_objects.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "mapping/plane_frame.hpp"
#include "mapping/segmentation/convexity_edges.hpp"
#include "mapping/segmentation/supporting_plane.hpp"
#include "mapping/top_rectangle.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"

namespace mmgrasp {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector2d;
using Eigen::Vector3d;
constexpr double kHalfPi = 1.57079632679489661923;
/// On a surface whose points are closer than a cell is wide, most cells have more neighbours than this.
constexpr int kFewNeighbours = 3;

/// Finds the plane, cuts what rises above it into patches, and joins these to objects.
class ObjectSegmenter {
 public:
  ObjectSegmenter(const Matrix3Xd& points, const Matrix3Xd& normals, const ObjectSegmentationOptions& options,
                  const Vector3d& eye)
      : points_(points), normals_(normals), options_(options), eye_(eye) {
    out_.labels.assign(points.cols(), -2);
    for (int i = 0; i < points.cols(); ++i) {
      if (!points.col(i).allFinite()) continue;
      if (points.col(i).cwiseAbs().maxCoeff() > kLargestLength)
        require_position(points.col(i), "points[" + std::to_string(i) + "]");
      if (normals.cols() > 0 && !normals.col(i).allFinite())
        require(false, "normals[" + std::to_string(i) + "]", "not finite",
                "must be a direction where the point is finite");
      measured_.push_back(i);
    }
  }

  ObjectSegmentation segment(const std::optional<SupportingPlane>& given) {
    is_given_ = given.has_value();
    out_.plane = given ? given : find_plane();
    if (!out_.plane) {
      if (!measured_.empty()) out_.warning = "no plane of a min_plane_share of the points has most others above it";
      return std::move(out_);
    }
    split_by_plane();
    if (!is_given_) bound_plane();
    part_objects();
    return std::move(out_);
  }

 private:
  std::vector<Vector3d> points_at(const std::vector<int>& indices) const {
    std::vector<Vector3d> out;
    for (const int i : indices) out.push_back(points_.col(i));
    return out;
  }

  /// Given normals of the points, or none.
  std::vector<Vector3d> normals_at(const std::vector<int>& indices) const {
    std::vector<Vector3d> out;
    if (normals_.cols() == 0) return out;
    for (const int i : indices) out.push_back(normals_.col(i));
    return out;
  }

  std::optional<SupportingPlane> find_plane() const {
    detail::SurfaceCells cells = detail::surface_cells(points_at(measured_), options_.leaf);
    if (normals_.cols() > 0) detail::average_normals(normals_at(measured_), cells);
    return detail::find_supporting_plane(cells, options_, eye_);
  }

  void split_by_plane() {
    for (const int i : measured_) {
      const double height = out_.plane->normal.dot(points_.col(i)) - out_.plane->offset;
      if (std::abs(height) <= options_.plane_tolerance) {
        out_.labels[i] = -1;
        out_.plane_inliers.push_back(i);
      } else if (height > 0 && height <= options_.max_height) {
        above_.push_back(i);
      }
    }
  }

  void bound_plane() {
    T_plane_world_ = detail::plane_frame(out_.plane->normal, out_.plane->offset).inverse(Eigen::Isometry);
    std::vector<Vector2d> on_plane;
    for (const Vector3d& p : detail::surface_of_plane(points_at(out_.plane_inliers), *out_.plane, options_.patch)) {
      on_plane.push_back((T_plane_world_ * p).head<2>());
    }
    for (const Vector2d& p : on_plane) middle_ += p / static_cast<double>(on_plane.size());
    hull_ = detail::hull_of(std::move(on_plane));
  }

  void part_objects() {
    const std::vector<Vector3d> standing = points_at(above_);
    detail::SurfaceCells cells = detail::surface_cells(standing, options_.leaf);
    if (normals_.cols() > 0) {
      detail::average_normals(normals_at(above_), cells);
    } else {
      detail::fit_normals(standing, eye_, cells);
      if (out_.plane->normal.dot(eye_) < out_.plane->offset) {
        out_.warning = "eye: lies below the plane, so the normals that were fitted point into the objects";
      }
    }
    warn_of_sparse_points(cells);
    const detail::SurfacePatches patches = detail::surface_patches(cells, options_.patch);
    const std::vector<int> part_of =
        detail::greedy_multicut(patches.size(), detail::convexity_edges(cells, patches, options_.concavity));
    std::vector<std::vector<int>> parts(patches.size());
    for (std::size_t k = 0; k < above_.size(); ++k) {
      parts[part_of[patches.patch_of[cells.cell_of[k]]]].push_back(above_[k]);
    }
    for (std::vector<int>& part : parts) {
      if (static_cast<int>(part.size()) >= options_.min_points && is_at_plane(part)) add_object(std::move(part));
    }
    number_objects();
  }

  void warn_of_sparse_points(const detail::SurfaceCells& cells) {
    std::ptrdiff_t sparse = 0;
    for (int c = 0; c < cells.size(); ++c) {
      sparse += cells.first_neighbour[c + 1] - cells.first_neighbour[c] <= kFewNeighbours;
    }
    if (2 * sparse <= cells.size() || !out_.warning.empty()) return;
    out_.warning = "leaf = " + std::to_string(options_.leaf) + ": most points have hardly a neighbour as near as that";
  }

  /// Some of it is over the surface of the plane that was found, or as near beside it as options say.
  bool is_at_plane(const std::vector<int>& part) const {
    if (is_given_) return true;
    return std::any_of(part.begin(), part.end(), [&](int i) {
      const Vector2d p = (T_plane_world_ * points_.col(i)).head<2>();
      const double off = (p - middle_).norm();
      return off <= options_.max_beside || detail::inside_hull(hull_, p - options_.max_beside / off * (p - middle_));
    });
  }

  void add_object(std::vector<int> indices) {
    SegmentedObject object;
    object.indices = std::move(indices);
    for (const int i : object.indices) object.bounds.extend(Vector3d(points_.col(i)));
    out_.objects.push_back(std::move(object));
  }

  void number_objects() {
    std::stable_sort(out_.objects.begin(), out_.objects.end(),
                     [](const auto& a, const auto& b) { return a.indices.size() > b.indices.size(); });
    for (std::size_t o = 0; o < out_.objects.size(); ++o) {
      for (const int i : out_.objects[o].indices) out_.labels[i] = static_cast<int>(o);
    }
  }

  const Matrix3Xd &points_, &normals_;
  const ObjectSegmentationOptions& options_;
  Vector3d eye_;
  std::vector<int> measured_, above_;
  Pose T_plane_world_ = Pose::Identity();
  bool is_given_ = false;
  /// Hull of the found plane's surface, in the plane's frame. A given plane has no end.
  std::vector<Vector2d> hull_;
  Vector2d middle_ = Vector2d::Zero();
  ObjectSegmentation out_;
};

}  // namespace

void ObjectSegmentationOptions::check() const {
  require(leaf >= 1e-5 && leaf <= 1, "leaf", leaf, "must be in [1e-5, 1] [m]");
  require_positive(plane_tolerance, "plane_tolerance", "m");
  require_numbers(up, "up");
  require(up_angle > 0 && up_angle <= kHalfPi, "up_angle", up_angle, "must be above 0 and at most pi/2 [rad]");
  require(min_plane_share >= 0 && min_plane_share <= 1, "min_plane_share", min_plane_share, "must be in [0, 1]");
  require_number(max_height, "max_height", "m");
  require(max_height > plane_tolerance, "max_height", max_height, "must be finite and more than plane_tolerance [m]");
  require_not_negative(max_beside, "max_beside", "m");
  require_number(patch, "patch", "m");
  require(patch >= 2 * leaf, "patch", patch, "must be finite and at least 2 leaf [m]");
  require(concavity > 0 && concavity < 2 * kHalfPi, "concavity", concavity, "must be in (0, pi) [rad]");
  require_count(min_points, "min_points");
  require_within(plane_iterations, 1, 1e6, "plane_iterations", "");
}

ObjectSegmentation segment_objects(const Matrix3Xd& points, const Matrix3Xd& normals,
                                   const ObjectSegmentationOptions& options,
                                   const std::optional<SupportingPlane>& plane, const Vector3d& eye) {
  options.check();
  require(normals.cols() == 0 || normals.cols() == points.cols(), "normals", static_cast<double>(normals.cols()),
          "must be one a point, " + std::to_string(points.cols()));
  require_numbers(eye, "eye", "m");
  if (plane) {
    require(std::abs(plane->normal.norm() - 1) <= 1e-6, "plane.normal", plane->normal.norm(), "must have unit length");
    require_number(plane->offset, "plane.offset", "m");
  }
  return ObjectSegmenter(points, normals, options, eye).segment(plane);
}

ObjectSegmentation segment_depth_image(const DepthImage& image, const ObjectSegmentationOptions& options,
                                       const std::optional<SupportingPlane>& plane) {
  image.check();
  const PinholeCamera& camera = image.camera;
  Matrix3Xd points = Matrix3Xd::Constant(3, static_cast<Eigen::Index>(camera.width) * camera.height, NAN);
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      if (image.at(u, v) > 0) points.col(static_cast<Eigen::Index>(v) * camera.width + u) = image.point(u, v);
    }
  }
  return segment_objects(points, Matrix3Xd(3, 0), options, plane, image.T_world_camera.translation());
}

}  // namespace mmgrasp
