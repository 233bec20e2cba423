#include "mmgrasp/mapping/frame_registration.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "mapping/sdf/frame_checks.hpp"
#include "mapping/sdf/frame_planes.hpp"
#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/core/parallel.hpp"

namespace mmgrasp {
namespace {

using Eigen::Matrix3Xd;
using Eigen::Vector3d;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr int kFewest = 100;          // matched pixels that fix a pose
constexpr double kLeastCosine = 0.7;  // of the pixel's normal and the map's: else they are two surfaces
constexpr double kTukey = 4.685;      // 95 % efficient on normal errors
constexpr double kSettled = 0.002;    // [m], of the trusted distance, which halves in each iteration
constexpr double kConverged = 3e-5;   // [m], of a point at the pixels' usual distance from their centre

/// A pixel of the frame, in the camera's frame.
struct FramePoint {
  Vector3d point, normal;
  double variance = 0;  ///< Variance of the point along the normal [m^2].
};

/// Pixels with a plane, spread evenly.
std::vector<FramePoint> frame_points(const DepthImage& image, const detail::FramePlanes& frame, int most) {
  std::vector<FramePoint> out;
  const PinholeCamera& c = image.camera;
  const int used = std::max(1, frame.report.used);
  const int stride = std::max(1, static_cast<int>(std::ceil(std::sqrt(static_cast<double>(used) / most))));
  for (int v = stride / 2; v < c.height; v += stride) {
    for (int u = stride / 2; u < c.width; u += stride) {
      const detail::PixelPlane& plane = frame.planes[static_cast<std::size_t>(v) * c.width + u];
      if (!(plane.weight > 0)) continue;
      const double z = image.at(u, v);
      out.push_back({{(u - c.cx) / c.fx * z, (v - c.cy) / c.fy * z, z},
                     Vector3d(plane.n[0], plane.n[1], plane.n[2]).normalized(),
                     1.0 / plane.weight});
    }
  }
  return out;
}

/// What one pixel says at a pose: how far its point is from the map's surface.
struct Match {
  bool found = false;
  double distance = 0, variance = 0;
  Vector3d normal;  ///< The map's surface normal.
};

/// The frame's points against the map.
class Matcher {
 public:
  Matcher(const ProbabilisticSdf& sdf, const std::vector<FramePoint>& points, const RegistrationOptions& options)
      : sdf_(sdf), field_(sdf.distance_field(0)), points_(points), options_(options) {}

  std::vector<Match> at(const Pose& T) const {
    std::vector<Match> out(points_.size());
    Matrix3Xd world(3, points_.size());
    for (std::size_t i = 0; i < points_.size(); ++i) world.col(i) = T * points_[i].point;
    const SdfValues values = sdf_.query(world, options_.threads);
    Matrix3Xd gradients;
    field_->distances(world, gradients);
    std::vector<int> far;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      if (values.known[i] && !gradients.col(i).isZero(0)) {
        take(i, T, values.mean[i], values.sigma[i], gradients.col(i), out[i]);
      } else {
        far.push_back(static_cast<int>(i));
      }
    }
    along_rays(far, T, world, out);
    return out;
  }

 private:
  void take(std::size_t i, const Pose& T, double distance, double sigma, const Vector3d& normal, Match& out) const {
    if (!(std::abs(distance) <= options_.max_distance)) return;
    if (normal.dot(T.linear() * points_[i].normal) < kLeastCosine) return;
    out = {true, distance, sigma * sigma + points_[i].variance, normal};
  }

  /// Beside the band in which the map is known: to the plane where the pixel's ray meets the surface.
  void along_rays(const std::vector<int>& far, const Pose& T, const Matrix3Xd& world, std::vector<Match>& out) const {
    const auto count = static_cast<Eigen::Index>(far.size());
    Matrix3Xd origins(3, count), directions(3, count);
    for (Eigen::Index k = 0; k < count; ++k) {
      // No surface far in front of the point hides that around it.
      const Vector3d ray = (world.col(far[k]) - T.translation()).normalized();
      origins.col(k) =
          world.col(far[k]) - std::min(2 * options_.max_distance, (world.col(far[k]) - T.translation()).norm()) * ray;
      directions.col(k) = ray;
    }
    const SdfHits hits = sdf_.cast_rays(origins, directions, options_.threads);
    for (Eigen::Index k = 0; k < count; ++k) {
      if (!hits.hit[k] || hits.normal.col(k).isZero(0)) continue;
      const Vector3d normal = hits.normal.col(k);
      take(far[k], T, normal.dot(world.col(far[k]) - hits.point.col(k)), hits.sigma[k], normal, out[far[k]]);
    }
  }

  const ProbabilisticSdf& sdf_;
  const std::shared_ptr<const DistanceField> field_;
  const std::vector<FramePoint>& points_;
  const RegistrationOptions& options_;
};

/// Moves a pose by a displacement and a rotation vector about its origin, along the world's axes.
Pose moved(const Pose& T, const Vector6& by) {
  Pose out = T;
  const Vector3d turn = by.tail<3>();
  const double angle = turn.norm();
  if (angle > 0) out.linear() = Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix() * T.linear();
  out.translation() = T.translation() + by.head<3>();
  return out;
}

/// The six motions about the middle of the frame's points, rotations as the way of a point at their usual distance
/// from it: so all six are metres, and directions that the surface does not fix show.
struct Motions {
  Vector3d middle;  ///< Place in the world [m].
  double arm = 1;   ///< Usual distance of the points from their middle [m].
  Matrix6 to_pose;  ///< From these motions to those of FrameUncertainty.

  Motions(const std::vector<FramePoint>& points, const Pose& T) {
    Vector3d sum = Vector3d::Zero();
    for (const FramePoint& each : points) sum += each.point;
    const Vector3d centre = sum / static_cast<double>(points.size());
    double squares = 0;
    for (const FramePoint& each : points) squares += (each.point - centre).squaredNorm();
    arm = std::max(1e-6, std::sqrt(squares / static_cast<double>(points.size())));
    middle = T * centre;
    // A turn r about the middle moves the camera by r x (camera - middle).
    const Vector3d way = T.translation() - middle;
    to_pose.setIdentity();
    Eigen::Matrix3d cross;
    cross << 0, way.z(), -way.y(), -way.z(), 0, way.x(), way.y(), -way.x(), 0;
    to_pose.topRightCorner<3, 3>() = cross / arm;
    to_pose.bottomRightCorner<3, 3>() /= arm;
  }
  Vector6 row(const Vector3d& point, const Vector3d& normal) const {
    Vector6 out;
    out << normal, (point - middle).cross(normal) / arm;
    return out;
  }
};

/// Normal equations of all matches at a pose.
struct System {
  Matrix6 information = Matrix6::Zero(), scatter = Matrix6::Zero();
  Vector6 gradient = Vector6::Zero();
  double weights = 0, squares = 0, chi = 0;
  int matched = 0;
};

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Tukey's weights, by the spread of the residuals where that is larger than their standard deviations. All within
/// `trusted` [m] count: while the pose is off, a large plane would have small parts on it look wrong.
System assemble(const std::vector<FramePoint>& points, const std::vector<Match>& matches, const Motions& motions,
                const Pose& T, double trusted) {
  System out;
  std::vector<double> ratios;
  for (const Match& match : matches) {
    if (match.found) ratios.push_back(std::abs(match.distance) / std::sqrt(match.variance));
  }
  if (ratios.empty()) return out;
  const double spread = std::max(1.0, 1.4826 * median(ratios));
  for (std::size_t i = 0; i < matches.size(); ++i) {
    const Match& match = matches[i];
    if (!match.found) continue;
    const double u = match.distance / std::max(trusted, std::sqrt(match.variance) * kTukey * spread);
    if (std::abs(u) >= 1) continue;
    const double weight = (1 - u * u) * (1 - u * u) / match.variance;
    // Noise of the map's normals would fix what nothing fixes. That of the frame's is independent of it, and the
    // product of the two has none in the mean.
    const Vector3d point = T * points[i].point;
    const Vector6 by_map = motions.row(point, match.normal),
                  by_frame = motions.row(point, T.linear() * points[i].normal);
    const Matrix6 product = by_map * by_frame.transpose();
    out.information += weight * 0.5 * (product + product.transpose());
    out.gradient += weight * match.distance * by_frame;
    out.weights += weight;
    out.squares += match.distance * match.distance;
    out.chi += weight * match.distance * match.distance;
    ++out.matched;
  }
  if (out.weights > 0) out.scatter = out.information / out.weights;
  return out;
}

class Registration {
 public:
  Registration(const ProbabilisticSdf& sdf, const std::vector<FramePoint>& points, const Pose& given,
               const Matrix6& covariance, const RegistrationOptions& options)
      : matcher_(sdf, points, options), points_(points), given_(given), covariance_(covariance), options_(options) {}

  FrameRegistration run() {
    FrameRegistration out;
    out.T_world_camera = given_;
    out.covariance = covariance_;
    out.compared = static_cast<int>(points_.size());
    if (out.compared < kFewest) return refuse(out, "only " + std::to_string(out.compared) + " pixels can be compared");
    Vector6 error = Vector6::Zero();  // of the given pose, as motions about the middle
    const Motions motions(points_, given_);
    const Matrix6 from_pose = motions.to_pose.inverse();
    const Matrix6 prior = (from_pose * covariance_ * from_pose.transpose()).inverse();
    double trusted = 2 * options_.max_distance;
    for (;; ++out.iterations, trusted *= 0.5) {
      detail::throw_if_interrupted();
      const Pose T = moved(given_, motions.to_pose * error);
      const System system = assemble(points_, matcher_.at(T), motions, T, trusted);
      out.matched = system.matched;
      if (system.matched < std::max(kFewest, static_cast<int>(options_.min_overlap * out.compared))) {
        return refuse(out, "only " + std::to_string(system.matched) + " of " + std::to_string(out.compared) +
                               " pixels meet the map's surface");
      }
      out.rms = std::sqrt(system.squares / system.matched);
      if (out.iterations == 0) out.rms_before = out.rms;
      const Eigen::SelfAdjointEigenSolver<Matrix6> directions(system.scatter);
      out.observed = static_cast<int>((directions.eigenvalues().array() > options_.min_observability).count());
      // Only what is observed speaks; what it says is shared out as the given covariance makes it likely.
      const Matrix6 V = directions.eigenvectors();
      const Vector6 kept = (directions.eigenvalues().array() > options_.min_observability).cast<double>();
      const Matrix6 observed = V * kept.asDiagonal() * V.transpose();
      const Matrix6 information = observed * system.information * observed;
      const Vector6 pull = observed * system.gradient + prior * error;
      const Vector6 step = -(information + prior).inverse() * pull;
      error += step;
      if (step.norm() < kConverged && trusted < kSettled) {
        out.covariance = posterior(information / misfit(system) + prior, motions);
        out.correction = std::sqrt(error.dot(prior * error));
        if (out.correction > options_.max_correction) {
          return refuse(out, "the pose that fits is " + std::to_string(out.correction) +
                                 " standard deviations from the given one");
        }
        out.T_world_camera = moved(given_, motions.to_pose * error);
        out.registered = true;
        return out;
      }
      if (out.iterations + 1 >= options_.max_iterations) {
        return refuse(out, "no pose was settled on in " + std::to_string(options_.max_iterations) + " iterations");
      }
    }
  }

 private:
  FrameRegistration refuse(FrameRegistration out, const std::string& reason) const {
    out.registered = false;
    out.T_world_camera = given_;
    out.covariance = covariance_;
    out.reason = reason;
    return out;
  }

  /// How much larger the squared distances are than their variances say.
  static double misfit(const System& system) { return std::max(1.0, system.chi / std::max(1, system.matched - 6)); }

  static Matrix6 posterior(const Matrix6& information, const Motions& motions) {
    const Matrix6 covariance = motions.to_pose * information.inverse() * motions.to_pose.transpose();
    return 0.5 * (covariance + covariance.transpose());
  }

  const Matcher matcher_;
  const std::vector<FramePoint>& points_;
  const Pose given_;
  const Matrix6 covariance_;
  const RegistrationOptions& options_;
};

}  // namespace

void RegistrationOptions::check() const {
  require_count(max_points, "max_points", kFewest);
  require_count(max_iterations, "max_iterations");
  require_positive(max_distance, "max_distance", "m");
  require(min_overlap > 0 && min_overlap <= 1, "min_overlap", min_overlap, "must be above 0 and at most 1");
  require_positive(max_correction, "max_correction");
  require(min_observability >= 0 && min_observability < 1, "min_observability", min_observability,
          "must be from 0 to below 1");
  resolve_threads(threads);
}

FrameRegistration register_frame(const ProbabilisticSdf& sdf, const DepthImage& given, const DepthCamera& camera,
                                 const FrameUncertainty& uncertainty, const RegistrationOptions& options) {
  options.check();
  require(sdf.frames() > 0, "sdf", "a map without a frame", "must hold what the frame is registered to");
  detail::check_frame(given, camera, uncertainty);
  const Eigen::LLT<Matrix6> factor(uncertainty.pose_covariance);
  require(factor.info() == Eigen::Success, "pose_covariance", "not positive definite",
          "must say for every direction how far the pose may be off");
  DepthImage image = given;
  image.clean();
  image.camera = camera.intrinsics;
  detail::check_depths(image);
  SdfOptions of_frame = sdf.options();
  of_frame.distance = SdfDistance::to_plane;
  of_frame.threads = options.threads;
  FrameUncertainty pixels;
  pixels.sigma = uncertainty.sigma;
  detail::FramePlanes frame;
  detail::frame_planes(image, camera, pixels, of_frame, frame);
  const std::vector<FramePoint> points = frame_points(image, frame, options.max_points);
  return Registration(sdf, points, image.T_world_camera, uncertainty.pose_covariance, options).run();
}

}  // namespace mmgrasp
