#include "mmgrasp/mapping/depth_image.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"

using namespace mmgrasp;
using Eigen::Vector3d;

namespace {

PinholeCamera small_camera() {
  PinholeCamera camera;
  camera.width = 96;
  camera.height = 64;
  camera.fx = 80;
  camera.fy = 85;
  camera.cx = 47.2;
  camera.cy = 31.7;
  return camera;
}

Pose some_pose(Rng& rng, double spread) {
  Pose T = Pose(rng.rotation());
  T.translation() << rng.uniform(-spread, spread), rng.uniform(-spread, spread), rng.uniform(1.0, 2.0);
  return T;
}

std::shared_ptr<const TriangleMesh> as_mesh(const Shape& shape) {
  return shape_mesh(shape, 160);
}

}  // namespace

TEST(DepthImage, PlaneInClosedForm) {
  const PinholeCamera camera = small_camera();
  const Vector3d n = Vector3d(0.2, -0.3, -1).normalized();
  const DepthImage image = render_depth({{Plane{n, -1.5}, Pose::Identity()}}, camera, Pose::Identity());
  int seen = 0;
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const Vector3d ray((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1);
      const double z = -1.5 / n.dot(ray);
      const bool in_range = z >= camera.nearest && z <= camera.farthest;
      EXPECT_NEAR(image.at(u, v), in_range ? z : 0, 1e-6 * 5);
      seen += in_range;
    }
  }
  EXPECT_EQ(image.points().size(), seen);
  for (const Vector3d& p : image.points()) EXPECT_NEAR(n.dot(p), -1.5, 1e-6);
}

TEST(DepthImage, SphereInClosedForm) {
  const PinholeCamera camera = small_camera();
  const Vector3d c(0.1, -0.05, 1.2);
  const double r = 0.35;
  const DepthImage image = render_depth({{Sphere{r}, Pose(Eigen::Translation3d(c))}}, camera, Pose::Identity());
  int hits = 0;
  for (int v = 0; v < camera.height; ++v) {
    for (int u = 0; u < camera.width; ++u) {
      const Vector3d ray((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1);
      const double b = ray.dot(c), a = ray.squaredNorm(), root = b * b - a * (c.squaredNorm() - r * r);
      EXPECT_NEAR(image.at(u, v), root > 0 ? (b - std::sqrt(root)) / a : 0, 1e-6);
      hits += root > 0;
    }
  }
  EXPECT_GT(hits, 1000);
}

/// The same body as a primitive and as triangles, from a camera that stands anywhere.
TEST(DepthImage, PrimitivesAgreeWithTheirMeshes) {
  const std::vector<Shape> shapes{Box{{0.3, 0.5, 0.2}}, Cylinder{0.2, 0.5}, Capsule{0.15, 0.3}, Sphere{0.3}};
  Rng rng(5);
  for (const Shape& shape : shapes) {
    const bool round = !std::holds_alternative<Box>(shape);
    for (int i = 0; i < 5; ++i) {
      const Pose T = some_pose(rng, 0.3), T_world_camera = Pose(rng.rotation());
      const DepthImage a = render_depth({{shape, T_world_camera * T}}, small_camera(), T_world_camera);
      const DepthImage b =
          render_depth({{MeshShape{as_mesh(shape)}, T_world_camera * T}}, small_camera(), T_world_camera);
      int different = 0, hits = 0;
      for (std::size_t k = 0; k < a.depth.size(); ++k) {
        hits += a.depth[k] > 0;
        different += std::abs(a.depth[k] - b.depth[k]) > (round ? 5e-3 : 1e-5);
      }
      EXPECT_GT(hits, 80);
      EXPECT_LE(different, round ? hits / 20 : 2) << shape_kind(shape);  // facets at silhouettes
    }
  }
}

TEST(DepthImage, ClosedMeshHasNoHoles) {
  // Inside a closed surface every ray meets it: a ray between two triangles would pass.
  const auto ball = as_mesh(Sphere{1.0});
  Rng rng(3);
  for (int i = 0; i < 4; ++i) {
    const Pose T = Pose(rng.rotation());
    const DepthImage image = render_depth({{MeshShape{ball}, T}}, small_camera(), Pose::Identity());
    for (const float z : image.depth) ASSERT_GT(z, 0.5f);
  }
}

TEST(DepthImage, NearerBodyHides) {
  const Pose near = Pose(Eigen::Translation3d(0, 0, 1)), far = Pose(Eigen::Translation3d(0, 0, 2));
  const DepthImage image =
      render_depth({{Box{{9, 9, 0.2}}, far}, {Box{{0.2, 0.2, 0.2}}, near}}, small_camera(), Pose::Identity());
  EXPECT_NEAR(image.at(47, 32), 0.9, 1e-6);
  EXPECT_NEAR(image.at(2, 2), 1.9, 1e-6);
  // What stands too close hides all the same, but is not measured.
  const DepthImage close =
      render_depth({{Box{{9, 9, 0.2}}, far}, {Box{{0.01, 0.01, 0.01}}, Pose(Eigen::Translation3d(0, 0, 0.05))}},
                   small_camera(), Pose::Identity());
  EXPECT_EQ(close.at(47, 32), 0);
}

TEST(DepthImage, VoxelsAreBoxes) {
  const auto centres = std::make_shared<std::vector<Vector3d>>(std::vector<Vector3d>{{0, 0, 0}, {0.1, 0, 0}});
  Pose T = Pose(Eigen::Translation3d(0.02, 0, 1));
  const DepthImage a = render_depth({{Voxels{centres, 0.1}, T}}, small_camera(), Pose::Identity());
  T.translation().x() += 0.05;
  const DepthImage b = render_depth({{Box{{0.2, 0.1, 0.1}}, T}}, small_camera(), Pose::Identity());
  for (std::size_t i = 0; i < a.depth.size(); ++i) EXPECT_NEAR(a.depth[i], b.depth[i], 1e-5);
}

TEST(DepthImage, NoiseHasItsSpreadAndRepeats) {
  PinholeCamera camera = small_camera();
  RenderOptions options;
  options.noise = 0.002;
  options.missing = 0.1;
  options.seed = 7;
  const std::vector<PlacedShape> scene{{Plane{-Vector3d::UnitZ(), -2.0}, Pose::Identity()}};
  const DepthImage image = render_depth(scene, camera, Pose::Identity(), options);
  double sum = 0, squares = 0;
  int n = 0;
  for (const float z : image.depth) {
    if (z == 0) continue;
    ++n;
    sum += z - 2.0;
    squares += (z - 2.0) * (z - 2.0);
  }
  const double pixels = camera.width * camera.height;
  EXPECT_NEAR(n / pixels, 0.9, 0.015);
  EXPECT_NEAR(sum / n, 0, 4e-4);
  EXPECT_NEAR(std::sqrt(squares / n), 0.008, 4e-4);  // 2 mm at 1 m is 8 mm at 2 m
  options.threads = 1;
  EXPECT_EQ(render_depth(scene, camera, Pose::Identity(), options).depth, image.depth);
  options.seed = 8;
  EXPECT_NE(render_depth(scene, camera, Pose::Identity(), options).depth, image.depth);
}

TEST(DepthImage, MisuseIsRefused) {
  EXPECT_THROW(render_depth({{Sphere{-1}, Pose::Identity()}}, small_camera(), Pose::Identity()), InvalidInput);
  RenderOptions options;
  options.missing = 2;
  EXPECT_THROW(render_depth({}, small_camera(), Pose::Identity(), options), InvalidInput);
  DepthImage image{small_camera(), Pose::Identity(), {}};
  EXPECT_THROW(image.points(), InvalidInput);
  image.depth.assign(96 * 64, NAN);
  image.depth[5] = -1;
  EXPECT_TRUE(image.points().empty());
}
