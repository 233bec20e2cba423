// render_depth(): what a depth camera sees of placed shapes.
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>

#include "mmgrasp/core/detail/numbers.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/limits.hpp"
#include "mmgrasp/core/parallel.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/geometry/detail/shape_rays.hpp"
#include "mmgrasp/geometry/ray_caster.hpp"
#include "mmgrasp/mapping/depth_image.hpp"

namespace mmgrasp {
namespace {

using Eigen::Vector3d;
constexpr int kBand = 16;                                      // rows of a work item
constexpr double kFront = std::numeric_limits<double>::min();  // only what lies in front of the camera is seen

struct Pixels {
  int u0 = 0, u1 = -1, v0 = 0, v1 = -1;  // inclusive; empty when u0 > u1
};

/// The pixels whose rays may meet the convex hull of these points; all of them when one lies beside or behind the
/// camera.
Pixels pixels_around(const PinholeCamera& camera, const std::vector<Vector3d>& points) {
  double lower[2] = {detail::kInfinity, detail::kInfinity}, upper[2] = {-detail::kInfinity, -detail::kInfinity};
  for (const Vector3d& p : points) {
    if (p.z() < 1e-6) return {0, camera.width - 1, 0, camera.height - 1};
    const double uv[2] = {camera.cx + camera.fx * p.x() / p.z(), camera.cy + camera.fy * p.y() / p.z()};
    for (int k = 0; k < 2; ++k) {
      lower[k] = std::min(lower[k], uv[k]);
      upper[k] = std::max(upper[k], uv[k]);
    }
  }
  const auto clamped = [](double value, int size) {  // a pixel more on either side costs little
    return static_cast<int>(std::clamp(value, -2.0, size + 1.0));
  };
  return {std::max(0, clamped(std::floor(lower[0]) - 1, camera.width)),
          std::min(camera.width - 1, clamped(std::ceil(upper[0]) + 1, camera.width)),
          std::max(0, clamped(std::floor(lower[1]) - 1, camera.height)),
          std::min(camera.height - 1, clamped(std::ceil(upper[1]) + 1, camera.height))};
}

struct Body {
  Shape shape;
  std::shared_ptr<const RayCaster>
      caster;  ///< Casts rays on meshes and voxels; the other shapes are met in closed form.
  Pose T_shape_camera;
  Pixels pixels;

  /// How far along the ray, or infinity. Nothing farther than `limit` is wanted.
  double first_hit(const Vector3d& origin, const Vector3d& direction, double limit) const {
    if (caster) return caster->closest_hit({origin, direction, kFront, limit}).distance;
    return detail::first_hit(shape, origin, direction);
  }
};

/// Casts a ray through every pixel near each body's outline, band of rows by band of rows.
class Renderer {
 public:
  Renderer(const std::vector<PlacedShape>& scene, const PinholeCamera& camera, const Pose& T_world_camera)
      : camera_(camera) {
    const Pose T_camera_world = T_world_camera.inverse(Eigen::Isometry);
    for (std::size_t i = 0; i < scene.size(); ++i) {
      check_shape(scene[i].shape, "scene shape " + std::to_string(i));
      add(scene[i].shape, T_camera_world * scene[i].T_world_shape);
    }
  }

  void render_band(int v0, int v1, float* depth) const {
    std::vector<double> nearest(static_cast<std::size_t>(camera_.width) * (v1 - v0), detail::kInfinity);
    for (const Body& body : bodies_) draw(body, v0, v1, nearest.data());
    for (std::size_t i = 0; i < nearest.size(); ++i) {
      const bool seen = nearest[i] >= camera_.nearest && nearest[i] <= camera_.farthest;
      depth[i] = seen ? static_cast<float>(nearest[i]) : 0.0f;
    }
  }

 private:
  /// Lengths along it are depths.
  Vector3d ray(int u, int v) const { return {(u - camera_.cx) / camera_.fx, (v - camera_.cy) / camera_.fy, 1.0}; }

  void add(const Shape& shape, const Pose& T) {
    Pixels pixels{0, camera_.width - 1, 0, camera_.height - 1};
    if (!std::holds_alternative<Plane>(shape)) {
      const Eigen::AlignedBox3d box = shape_bounds(shape);
      std::vector<Vector3d> corners;
      for (int k = 0; k < 8; ++k) corners.push_back(T * box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(k)));
      const bool behind = std::all_of(corners.begin(), corners.end(), [](const Vector3d& c) { return c.z() <= 0; });
      if (behind) return;
      pixels = pixels_around(camera_, corners);
    }
    bodies_.push_back({shape, caster_of(shape), T.inverse(Eigen::Isometry), pixels});
  }

  /// One for all places where the same mesh stands.
  std::shared_ptr<const RayCaster> caster_of(const Shape& shape) {
    if (std::holds_alternative<Voxels>(shape)) return std::make_shared<RayCaster>(*shape_mesh(shape));
    const auto* mesh = std::get_if<MeshShape>(&shape);
    if (!mesh) return nullptr;
    auto& caster = casters_[mesh->mesh.get()];
    if (!caster) caster = std::make_shared<RayCaster>(*mesh->mesh);
    return caster;
  }

  void draw(const Body& body, int v0, int v1, double* nearest) const {
    const Vector3d origin = body.T_shape_camera.translation();
    for (int v = std::max(v0, body.pixels.v0); v <= std::min(v1 - 1, body.pixels.v1); ++v) {
      for (int u = body.pixels.u0; u <= body.pixels.u1; ++u) {
        double& best = nearest[static_cast<std::size_t>(v - v0) * camera_.width + u];
        best = std::min(best, body.first_hit(origin, body.T_shape_camera.linear() * ray(u, v), best));
      }
    }
  }

  PinholeCamera camera_;
  std::vector<Body> bodies_;
  std::map<const TriangleMesh*, std::shared_ptr<const RayCaster>> casters_;
};

void disturb(DepthImage& image, const RenderOptions& options, int v) {
  for (int u = 0; u < image.camera.width; ++u) {
    const std::size_t pixel = static_cast<std::size_t>(v) * image.camera.width + u;
    Rng rng(options.seed, pixel);
    float& z = image.depth[pixel];
    const double noise = rng.normal(), luck = rng.uniform();
    if (z > 0) z = std::max(0.0f, static_cast<float>(z + options.noise * z * z * noise));
    if (luck < options.missing) z = 0;
  }
}

}  // namespace

void RenderOptions::check() const {
  require_not_negative(noise, "noise", "m");
  require(missing >= 0 && missing <= 1, "missing", missing, "must be in [0, 1]");
  resolve_threads(threads);  // says what is wrong
}

DepthImage render_depth(const std::vector<PlacedShape>& scene, const PinholeCamera& camera, const Pose& T_world_camera,
                        const RenderOptions& options) {
  options.check();
  camera.check();
  DepthImage image{camera, checked_pose(T_world_camera.matrix(), "T_world_camera"), {}};
  image.depth.assign(static_cast<std::size_t>(camera.width) * camera.height, 0.0f);
  const Renderer renderer(scene, camera, image.T_world_camera);
  const bool disturbed = options.noise > 0 || options.missing > 0;
  parallel_for((camera.height + kBand - 1) / kBand, options.threads, [&](std::size_t band, int) {
    const int v0 = static_cast<int>(band) * kBand, v1 = std::min(v0 + kBand, camera.height);
    renderer.render_band(v0, v1, image.depth.data() + static_cast<std::size_t>(v0) * camera.width);
    for (int v = v0; disturbed && v < v1; ++v) disturb(image, options, v);
  });
  return image;
}

}  // namespace mmgrasp
