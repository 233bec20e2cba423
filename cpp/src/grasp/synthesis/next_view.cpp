#include "mmgrasp/grasp/next_view.hpp"

#include <algorithm>
#include <cmath>

#include "grasp/synthesis/map_surface.hpp"
#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/core/parallel.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/geometry/ray_caster.hpp"

namespace mmgrasp {
namespace {

using Eigen::Vector3d;

/// What all of the certain surface counts beside the probability, which is 0 until a hand fits and says nothing then.
constexpr double kCertainty = 1.0;

/// A camera at `eye` that looks at `target`, the image's x level.
Pose looking_at(const Vector3d& eye, const Vector3d& target) {
  const Vector3d z = (target - eye).normalized();
  const Vector3d aside = z.cross(Vector3d::UnitZ());
  const Vector3d x = aside.norm() > 1e-6 ? aside.normalized() : Vector3d::UnitX();
  Pose T = Pose::Identity();
  T.linear() << x, z.cross(x), z;
  T.translation() = eye;
  return T;
}

/// Even over the band of a sphere between two elevations: each turned by the golden angle from the last.
std::vector<Pose> poses_around(const Vector3d& middle, const NextViewOptions& options) {
  const double golden = detail::kPi * (3 - std::sqrt(5.0));
  const double low = std::sin(options.min_elevation), high = std::sin(options.max_elevation);
  std::vector<Pose> out;
  for (int k = 0; k < options.candidates; ++k) {
    const double z = low + (high - low) * (k + 0.5) / options.candidates, across = std::sqrt(1 - z * z);
    const Vector3d way(across * std::cos(golden * k), across * std::sin(golden * k), z);
    out.push_back(looking_at(middle + options.distance * way, middle));
  }
  return out;
}

/// The camera with no more than so many columns.
DepthCamera with_width(DepthCamera camera, int most) {
  PinholeCamera& c = camera.intrinsics;
  const int factor = (c.width + most - 1) / most;
  if (factor <= 1) return camera;
  c.width = std::max(1, c.width / factor);
  c.height = std::max(1, c.height / factor);
  c.fx /= factor;
  c.fy /= factor;
  c.cx = (c.cx + 0.5) / factor - 0.5;
  c.cy = (c.cy + 0.5) / factor - 0.5;
  return camera;
}

/// What is there, as far as one can tell: the map's surface, and behind it the hull of what was seen of the object.
class ImaginedScene {
 public:
  ImaginedScene(const ProbabilisticSdf& map, const detail::MapSurface& surface, std::optional<double> table)
      : map_(map), table_(table), hull_(*hull_of(down_to(surface.object, table), map.options().voxel)) {}

  /// The frame from a pose without noise, and the share of the object's pixels that the map does not know.
  DepthImage seen_from(const Pose& T, const DepthCamera& camera, double& unseen) const {
    const PinholeCamera& c = camera.intrinsics;
    const Eigen::Index count = static_cast<Eigen::Index>(c.width) * c.height;
    Eigen::Matrix3Xd rays(3, count);
    for (Eigen::Index i = 0; i < count; ++i) {
      const double u = static_cast<double>(i % c.width), v = static_cast<double>(i / c.width);
      rays.col(i) = T.linear() * Vector3d((u - c.cx) / c.fx, (v - c.cy) / c.fy, 1);
    }
    const Eigen::Matrix3Xd eyes = T.translation().replicate(1, count);
    const SdfHits known = map_.cast_rays(eyes, rays, 1);
    DepthImage out{c, T, std::vector<float>(count, 0.0f)};
    int of_object = 0, of_hull = 0;
    for (Eigen::Index i = 0; i < count; ++i) {
      const RayHit hull = hull_.closest_hit({T.translation(), rays.col(i)});
      double depth = known.hit[i] ? known.distance[i] : kInfinity;
      // Inside the hull the map's own surface counts; what it has behind the hull is hidden by the unseen side.
      if (hull) {
        ++of_object;
        const bool shown = known.hit[i] && (hull_.contains(known.point.col(i)) ||
                                            depth < hull.distance + 2 * map_.options().truncation);
        of_hull += !shown;
        if (!shown) depth = hull.distance;
      }
      if (table_ && rays(2, i) < 0) depth = std::min(depth, (*table_ - T.translation().z()) / rays(2, i));
      if (depth >= c.nearest && depth <= c.farthest) out.depth[i] = static_cast<float>(depth);
    }
    unseen = of_object > 0 ? static_cast<double>(of_hull) / of_object : 0;
    return out;
  }

 private:
  static constexpr double kInfinity = detail::kInfinity;

  static std::vector<Vector3d> down_to(std::vector<Vector3d> points, std::optional<double> table) {
    const std::size_t count = points.size();
    for (std::size_t i = 0; table && i < count; ++i) points.emplace_back(points[i].x(), points[i].y(), *table);
    return points;
  }

  /// A flat patch of surface is taken for a body two voxels thick.
  static std::shared_ptr<const TriangleMesh> hull_of(std::vector<Vector3d> points, double voxel) {
    try {
      return convex_hull(points);
    } catch (const InvalidInput&) {
      const std::size_t count = points.size();
      for (int axis = 0; axis < 3; ++axis) {
        for (std::size_t i = 0; i < count; ++i) {
          for (const double side : {-voxel, voxel}) points.push_back(points[i] + side * Vector3d::Unit(axis));
        }
      }
      return convex_hull(points);
    }
  }

  const ProbabilisticSdf& map_;
  const std::optional<double> table_;
  const RayCaster hull_;
};

/// What of the map decides about grasps of the object: frames are imagined in copies of it.
ProbabilisticSdf around(const ProbabilisticSdf& map, const detail::MapSurface& surface,
                        const SynthesisOptions& options) {
  Eigen::AlignedBox3d box;
  if (options.object) box.extend(*options.object);
  for (const Vector3d& point : surface.object) box.extend(point);
  const Vector3d reach = Vector3d::Constant(detail::kHandReach);
  return map.cropped({box.min() - reach, box.max() + reach});
}

double best_of(const GraspSynthesis& found) {
  return found.grasps.empty() ? 0 : found.grasps.front().quality;
}

/// How much of the object's surface is known, and how well: its points, each 1 where it is certain and 0 at max_sigma.
double certain_points(const ProbabilisticSdf& map, const SynthesisOptions& options) {
  const detail::MapSurface surface(map, options);
  double sum = 0;
  for (const double sigma : surface.object_sigma) sum += std::max(0.0, 1 - sigma / options.success.max_sigma);
  return sum;
}

/// Puts an imagined frame into a copy of the map, and adds to the candidate what that brings.
void imagine(const ProbabilisticSdf& map, const HandModel& hand, DepthImage image, const DepthCamera& camera,
             const NextViewOptions& options, const Monitor& monitor, Rng rng, ViewCandidate& candidate) {
  for (float& z : image.depth) {
    if (z > 0) z = static_cast<float>(z + camera.noise.sigma(z) * rng.normal());
  }
  ProbabilisticSdf after = map;
  after.integrate(image, camera, options.uncertainty);
  SynthesisOptions search = options.synthesis;
  search.threads = 1;
  Monitor quiet;
  quiet.stop = monitor.stop;
  candidate.probability += best_of(synthesize_grasps(after, hand, search, quiet)) / options.draws;
  candidate.certain += certain_points(after, search) / options.draws;
}

}  // namespace

void NextViewOptions::check() const {
  require(candidates >= 1 && candidates <= 1000000, "candidates", candidates, "must be in [1, 1000000]");
  require_positive(distance, "distance", "m");
  require(min_elevation >= -detail::kPi / 2 && min_elevation < max_elevation, "min_elevation", min_elevation,
          "must be from -pi/2 to below max_elevation [rad]");
  require(max_elevation <= detail::kPi / 2, "max_elevation", max_elevation, "must be at most pi/2 [rad]");
  require_count(draws, "draws");
  require(max_width > 0, "max_width", max_width, "must be positive");
  require(uncertainty.sigma.empty(), "uncertainty.sigma", "given", "must be empty: the camera's noise counts");
  resolve_threads(threads);
  synthesis.check();
}

NextView next_view(const ProbabilisticSdf& map, const HandModel& hand, const DepthCamera& camera,
                   const NextViewOptions& options, const Monitor& monitor, const ArmReach& arm) {
  options.check();
  camera.check();
  const DepthCamera eye = with_width(camera, options.max_width);
  const detail::MapSurface surface(map, options.synthesis);
  NextView out;
  for (const Pose& T : poses_around(surface.extent.centre, options)) {
    if (monitor.stopped()) break;
    ViewCandidate candidate;
    candidate.T_world_camera = T;
    const Rejection cause = arm ? arm(T, candidate.q) : Rejection::none;
    if (cause == Rejection::none) {
      out.candidates.push_back(candidate);
    } else {
      out.arm.add(cause);
    }
  }
  const ProbabilisticSdf nearby = around(map, surface, options.synthesis);
  const ImaginedScene scene(map, surface, options.synthesis.table);
  Monitor quiet;
  quiet.stop = monitor.stop;
  out.probability_now = best_of(synthesize_grasps(map, hand, options.synthesis, quiet));
  const auto rate = [&](std::size_t i, int) {
    ViewCandidate& candidate = out.candidates[i];
    const DepthImage image = scene.seen_from(candidate.T_world_camera, eye, candidate.unseen);
    for (int draw = 0; draw < options.draws && !monitor.stopped(); ++draw) {
      imagine(nearby, hand, image, eye, options, monitor, Rng(options.seed, i * options.draws + draw), candidate);
    }
  };
  if (!parallel_for(out.candidates.size(), options.threads, rate, monitor, "next view") || monitor.stopped()) {
    out.outcome = Outcome::stopped;
    return out;
  }
  double most = 0;
  for (const ViewCandidate& each : out.candidates) most = std::max(most, each.certain);
  for (ViewCandidate& each : out.candidates) each.certain /= std::max(1.0, most);
  const auto score = [](const ViewCandidate& c) { return c.probability + kCertainty * c.certain; };
  std::stable_sort(out.candidates.begin(), out.candidates.end(),
                   [&](const ViewCandidate& a, const ViewCandidate& b) { return score(a) > score(b); });
  out.outcome = out.candidates.empty() ? Outcome::not_found : Outcome::solved;
  return out;
}

NextView next_view(const ProbabilisticSdf& map, const Hand& hand, const DepthCamera& camera,
                   const NextViewOptions& options, const Monitor& monitor, const ArmReach& arm) {
  return next_view(map, *make_hand_model(hand), camera, options, monitor, arm);
}

}  // namespace mmgrasp
