// What a frame gets wrong, and what has changed since: the gate for outliers and the persistence of surfaces.
#include <gtest/gtest.h>

#include <cmath>

#include "mapping/sdf_scenes.hpp"
#include "mmgrasp/core/detail/instruction_set.hpp"
#include "mmgrasp/core/error.hpp"

using namespace mmgrasp;
using namespace mmgrasp::test;
using Eigen::Vector3d;

namespace {

const std::vector<PlacedShape>& table_with_parts() {
  static const std::vector<PlacedShape> scene{
      {Box{{0.5, 0.5, 0.02}}, Pose(Eigen::Translation3d(0, 0, -0.01))},
      {Box{{0.06, 0.04, 0.05}}, Pose(Eigen::Translation3d(0.05, 0.02, 0.025))},
      {Cylinder{0.025, 0.08}, Pose(Eigen::Translation3d(-0.05, -0.02, 0.04))},
  };
  return scene;
}

/// Distance of a point from the scene's surface, in closed form; the box's and the can's from outside and inside.
double distance_of(const Vector3d& p) {
  const auto of_box = [](const Vector3d& q, const Vector3d& half) {
    const Vector3d d = q.cwiseAbs() - half;
    return d.cwiseMax(0).norm() + std::min(d.maxCoeff(), 0.0);
  };
  const Vector3d can = p - Vector3d(-0.05, -0.02, 0.04);
  const Eigen::Vector2d c(std::hypot(can.x(), can.y()) - 0.025, std::abs(can.z()) - 0.04);
  const double of_can = c.cwiseMax(0).norm() + std::min(c.maxCoeff(), 0.0);
  return std::min({of_box(p - Vector3d(0, 0, -0.01), {0.25, 0.25, 0.01}),
                   of_box(p - Vector3d(0.05, 0.02, 0.025), {0.03, 0.02, 0.025}), of_can});
}

Pose eye_of(int k, int count) {
  const double angle = 2 * M_PI * k / count, height = 0.20 + 0.06 * (k % 3);
  return look_at({0.28 * std::cos(angle), 0.28 * std::sin(angle), height}, {0, 0, 0.02});
}

/// Any depth in the camera's range, in a share of the pixels.
void spoil(DepthImage& image, double share, Rng& rng) {
  for (float& z : image.depth) {
    if (rng.uniform() < share) z = static_cast<float>(rng.uniform(0.15, 0.6));
  }
}

/// Pixels beside a jump of the depth see both sides of it, in shares by chance.
void smear_jumps(DepthImage& image, Rng& rng) {
  const std::vector<float> before = image.depth;
  const int width = image.camera.width, height = image.camera.height;
  for (int v = 0; v < height; ++v) {
    for (int u = 0; u + 1 < width; ++u) {
      const float a = before[v * width + u], b = before[v * width + u + 1];
      if (a > 0 && b > 0 && std::abs(a - b) > 0.01f) {
        const float share = static_cast<float>(rng.uniform());
        image.depth[v * width + u] = a + share * (b - a);
      }
    }
  }
}

struct SurfaceError {
  double rms = 0, farthest = 0;
  int beyond = 0;  ///< Vertices farther than 3 mm from any surface.
  int vertices = 0;
};

SurfaceError error_of(const ProbabilisticSdf& sdf) {
  SurfaceError out;
  const SdfMesh mesh = sdf.mesh();
  for (const Vector3d& vertex : mesh.mesh->vertices) {
    const double off = std::abs(distance_of(vertex));
    out.rms += off * off;
    out.farthest = std::max(out.farthest, off);
    out.beyond += off > 0.003;
    ++out.vertices;
  }
  out.rms = std::sqrt(out.rms / out.vertices);
  return out;
}

enum class Fault { none, speckles, jumps };

SurfaceError error_with(Fault fault, double gate, int frames = 12) {
  SdfOptions options;
  options.outlier_gate = gate;
  ProbabilisticSdf sdf(options);
  const DepthCamera camera = small_camera(0.001);
  for (int k = 0; k < frames; ++k) {
    DepthImage image = frame_of(table_with_parts(), camera, eye_of(k, frames));
    Rng rng(23, static_cast<std::uint64_t>(k));
    disturb(image, camera, rng);
    if (fault == Fault::speckles) spoil(image, 0.01, rng);
    if (fault == Fault::jumps) smear_jumps(image, rng);
    sdf.integrate(image, camera);
  }
  const SurfaceError out = error_of(sdf);
  std::printf("fault %d, gate %.0f: rms %.3f mm, farthest %.2f mm, %d of %d vertices beyond 3 mm\n",
              static_cast<int>(fault), gate, 1e3 * out.rms, 1e3 * out.farthest, out.beyond, out.vertices);
  return out;
}

}  // namespace

TEST(SdfOutliers, OnePercentOfThePixelsDoNotMoveTheSurface) {
  const SurfaceError clean = error_with(Fault::none, 0), clean_gated = error_with(Fault::none, 5);
  const SurfaceError open = error_with(Fault::speckles, 0), gated = error_with(Fault::speckles, 5);
  EXPECT_NEAR(clean_gated.rms, clean.rms, 0.02e-3);
  EXPECT_LT(gated.rms, clean.rms + 0.03e-3);
  EXPECT_LE(gated.beyond, clean.beyond + gated.vertices / 1000);
  EXPECT_GE(gated.vertices, clean.vertices * 0.98);
  EXPECT_LE(gated.rms, open.rms);
}

TEST(SdfOutliers, PixelsBetweenTwoSurfacesMakeNone) {
  const SurfaceError clean = error_with(Fault::none, 0);
  const SurfaceError open = error_with(Fault::jumps, 0), gated = error_with(Fault::jumps, 5);
  EXPECT_LT(gated.rms, clean.rms + 0.03e-3);
  EXPECT_LE(gated.beyond, clean.beyond + gated.vertices / 1000);
  EXPECT_LE(gated.rms, open.rms + 0.01e-3);
}

TEST(SdfOutliers, APixelApartFromItsNeighboursIsLeftOut) {
  SdfOptions options;
  options.outlier_gate = 5;
  const DepthCamera camera = small_camera(0.001);
  DepthImage image = wall(camera, 0.3);
  image.depth[60 * 160 + 40] = 0.307f;  // near enough to count as the same surface
  image.depth[60 * 160 + 80] = 0.4f;
  image.depth[60 * 160 + 120] = 0.2f;
  ProbabilisticSdf gated(options), open;
  const IntegrationReport report = gated.integrate(image, camera);
  EXPECT_EQ(report.outliers, 3);
  EXPECT_EQ(open.integrate(image, camera).outliers, 0);
  EXPECT_GE(report.used, 160 * 120 - 8);  // beside the nearest one a few planes are too slanted
  // Beside a speckle a pixel is as certain as elsewhere; without the gate it counts as a rim.
  const Vector3d beside((82 - 79.5) / 200 * 0.3, (60 - 59.5) / 200 * 0.3, 0.3);
  EXPECT_LT(gated.query(beside).sigma[0], 1.1e-3);
  EXPECT_GT(open.query(beside).sigma[0], 1.5e-3);
}

TEST(SdfOutliers, WhatContradictsAKnownSurfaceIsHeldBackUntilItIsTheRule) {
  SdfOptions options;
  options.outlier_gate = 5;
  const DepthCamera camera = small_camera(0.0003);
  const Vector3d voxel(0, 0, 0.3);
  ProbabilisticSdf sdf(options), open;
  for (int k = 0; k < 5; ++k) {
    EXPECT_EQ(sdf.integrate(wall(camera, 0.3), camera).contradicted, 0);
    open.integrate(wall(camera, 0.3), camera);
  }
  // 3 mm are more than 5 times 0.3 mm with that of the mean, 1 mm is not.
  EXPECT_GT(sdf.integrate(wall(camera, 0.303), camera).contradicted, 1000);
  open.integrate(wall(camera, 0.303), camera);
  EXPECT_NEAR(sdf.query(voxel).mean[0], 0, 1e-7);
  EXPECT_NEAR(open.query(voxel).mean[0], 0.0005, 1e-6);
  for (int k = 0; k < 4; ++k) sdf.integrate(wall(camera, 0.303), camera);
  EXPECT_NEAR(sdf.query(voxel).mean[0], 0, 1e-7);  // five frames against five
  sdf.integrate(wall(camera, 0.303), camera);
  EXPECT_NEAR(sdf.query(voxel).mean[0], 0.003, 1e-6);
  EXPECT_NEAR(sdf.query(voxel).sigma[0], 0.0003, 1e-6);  // of that one frame
}

TEST(SdfOutliers, WhatIsTakenAwayIsGoneAndWhatAppearsIsThere) {
  const DepthCamera camera = small_camera();
  const PlacedShape floor{Box{{0.4, 0.4, 0.02}}, Pose(Eigen::Translation3d(0, 0, -0.01))};
  const PlacedShape box{Box{{0.04, 0.04, 0.04}}, Pose(Eigen::Translation3d(0, 0, 0.02))};
  const auto eye = [](int k) { return look_at({0.15 * std::cos(k), 0.15 * std::sin(k), 0.3}, {0, 0, 0}); };
  const Vector3d down(0, 0, -1), from(0.004, 0.004, 0.2), beside(0.1, 0.05, 0.2);
  for (const int persistence : {5, 254}) {
    SdfOptions options;
    options.persistence = persistence;
    ProbabilisticSdf sdf(options);
    for (int k = 0; k < 40; ++k) sdf.integrate(frame_of({floor, box}, camera, eye(k)), camera);
    ASSERT_NEAR(sdf.cast_rays(from, down).point(2, 0), 0.04, 2e-4);
    int until_gone = 0, until_back = 0;
    while (sdf.cast_rays(from, down).point(2, 0) > 0.03 && until_gone < 60) {
      sdf.integrate(frame_of({floor}, camera, eye(++until_gone)), camera);
    }
    EXPECT_NEAR(sdf.cast_rays(from, down).point(2, 0), 0, 2e-4);
    EXPECT_EQ(until_gone, persistence == 5 ? 6 : 41);
    for (int k = 0; k < 20; ++k) sdf.integrate(frame_of({floor}, camera, eye(k)), camera);
    // A new one where nothing was is there at once, the same one at its old place after as many frames as it was gone.
    const PlacedShape other{Box{{0.04, 0.04, 0.04}}, Pose(Eigen::Translation3d(0.1, 0.05, 0.02))};
    while (!(sdf.cast_rays(from, down).point(2, 0) > 0.03) && until_back < 60) {
      sdf.integrate(frame_of({floor, box, other}, camera, eye(++until_back)), camera);
      ASSERT_NEAR(sdf.cast_rays(beside, down).point(2, 0), 0.04, 5e-4);
    }
    EXPECT_LE(until_back, persistence == 5 ? 6 : 21);
  }
}

TEST(SdfOutliers, SameBitsWithAnyThreadsAndInstructions) {
  const DepthCamera camera = small_camera();
  const auto map = [&](int threads) {
    SdfOptions options;
    options.threads = threads;
    options.outlier_gate = 3;
    options.persistence = 3;
    ProbabilisticSdf sdf(options);
    int contradicted = 0, outliers = 0;
    for (int k = 0; k < 14; ++k) {
      // Part of the scene is moved on the way, by less and by more than the map's band.
      std::vector<PlacedShape> scene = table_with_parts();
      scene[1].T_world_shape.translation().z() += k >= 6 ? 0.004 : 0;
      if (k >= 8) scene.pop_back();
      DepthImage image = frame_of(scene, camera, eye_of(k, 14));
      Rng rng(5, static_cast<std::uint64_t>(k));
      disturb(image, camera, rng);
      spoil(image, 0.01, rng);
      const IntegrationReport report = sdf.integrate(image, camera, FrameUncertainty::of_pose(0.0002, 0.0005));
      contradicted += report.contradicted;
      outliers += report.outliers;
    }
    EXPECT_GT(contradicted, 100);
    EXPECT_GT(outliers, 1000);
    return bytes_of(sdf);
  };
  const std::string one = map(1);
  EXPECT_EQ(map(2), one);
  EXPECT_EQ(map(5), one);
  const std::string usual = detail::instruction_sets().front();
  for (const std::string& set : detail::instruction_sets()) {
    detail::use_instruction_set(set);
    EXPECT_EQ(map(2), one) << set;
  }
  detail::use_instruction_set(usual);
}

TEST(SdfOutliers, OptionsOutOfRangeAreRefused) {
  for (const double gate : {-1.0, 0.5, 2.9, std::nan(""), std::numeric_limits<double>::infinity()}) {
    SdfOptions options;
    options.outlier_gate = gate;
    EXPECT_THROW(ProbabilisticSdf{options}, InvalidInput) << gate;
  }
  for (const int persistence : {-1, 0, 255}) {
    SdfOptions options;
    options.persistence = persistence;
    EXPECT_THROW(ProbabilisticSdf{options}, InvalidInput) << persistence;
  }
}
