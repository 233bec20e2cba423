#include "mmgrasp/mapping/probabilistic_sdf.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "mapping/sdf_scenes.hpp"
#include "mmgrasp/core/detail/instruction_set.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/geometry/ray_caster.hpp"

using namespace mmgrasp;
using namespace mmgrasp::test;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;

TEST(ProbabilisticSdf, MeshOfABoxIsThatOfItsCells) {
  ProbabilisticSdf sdf;
  const DepthCamera camera = small_camera();
  sdf.integrate(
      frame_of({{Plane{Eigen::Vector3d::UnitZ(), 0.0}, Pose::Identity()}}, camera, look_at({0, 0, 0.3}, {0, 0, 0})),
      camera);
  const SdfMesh whole = sdf.mesh();
  const double side = 8 * sdf.options().voxel;
  const Eigen::AlignedBox3d box(Eigen::Vector3d(0.1 * side, 0.1 * side, -0.02),
                                Eigen::Vector3d(0.9 * side, 1.9 * side, 0.02));
  const SdfMesh some = sdf.mesh(box);
  // Triangles with all corners within those cells, by place.
  const auto inside = [&](const TriangleMesh& mesh, const std::array<int, 3>& t) {
    return std::all_of(t.begin(), t.end(), [&](int k) {
      const Eigen::Vector3d& p = mesh.vertices[k];
      return p.x() >= 0 && p.x() <= side && p.y() >= 0 && p.y() <= 2 * side;
    });
  };
  std::size_t expected = 0;
  for (const auto& t : whole.mesh->triangles) expected += inside(*whole.mesh, t);
  EXPECT_GT(expected, 100u);
  EXPECT_EQ(some.mesh->triangles.size(), expected);
  for (const auto& t : some.mesh->triangles) EXPECT_TRUE(inside(*some.mesh, t));
  EXPECT_EQ(some.sigma.size(), some.mesh->vertices.size());
  EXPECT_TRUE(sdf.mesh(Eigen::AlignedBox3d(Eigen::Vector3d(5, 5, 5), Eigen::Vector3d(6, 6, 6))).mesh->vertices.empty());
}

/// P3 (4.16), (4.17) against weighted least squares over all frames at once, at voxels, in closed form.
TEST(ProbabilisticSdf, RecursionIsBatchLeastSquares) {
  ProbabilisticSdf sdf;
  const double depths[] = {0.300, 0.301, 0.2985, 0.3022, 0.2991}, sigmas[] = {0.001, 0.002, 0.0005, 0.003, 0.0012};
  double information = 0;
  for (int k = 0; k < 5; ++k) {
    DepthCamera camera = small_camera(sigmas[k]);
    camera.name = "camera " + std::to_string(k);
    sdf.integrate(wall(camera, depths[k]), camera);
    information += 1 / (sigmas[k] * sigmas[k]);
  }
  for (const double z : {0.298, 0.300, 0.302}) {
    double sum = 0;
    for (int k = 0; k < 5; ++k) sum += (depths[k] - z) / (sigmas[k] * sigmas[k]);
    const SdfValues at = sdf.query(Vector3d(0.004, -0.002, z));
    ASSERT_TRUE(at.known[0]);
    EXPECT_NEAR(at.mean[0], sum / information, 2e-7);
    EXPECT_NEAR(at.sigma[0], 1 / std::sqrt(information), 1e-4 / std::sqrt(information));
  }
}

TEST(ProbabilisticSdf, OrderOfFramesDoesNotMatter) {
  const DepthCamera camera = small_camera();
  const std::vector<DepthImage> frames = noisy_sphere_frames(12, camera, 0.05);
  ProbabilisticSdf forward, backward;
  for (int k = 0; k < 12; ++k) forward.integrate(frames[k], camera);
  for (int k = 11; k >= 0; --k) backward.integrate(frames[k], camera);
  const Matrix3Xd points = random_points(20000, 0.06);
  const SdfValues a = forward.query(points), b = backward.query(points);
  EXPECT_TRUE(a.known == b.known);
  int known = 0;
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    if (!a.known[i] || !b.known[i]) continue;
    ++known;
    EXPECT_NEAR(a.mean[i], b.mean[i], 1e-7);
    EXPECT_NEAR(a.sigma[i], b.sigma[i], 1e-5 * a.sigma[i]);
  }
  EXPECT_GT(known, 1000);
}

TEST(ProbabilisticSdf, SameBitsWithAnyThreadsAndInstructions) {
  const DepthCamera camera = small_camera();
  DepthCamera biased = small_camera(0.0015);
  biased.name = "biased";
  biased.systematic = 0.0005;
  const std::vector<DepthImage> frames = noisy_sphere_frames(6, camera, 0.05);
  const auto map = [&](int threads) {
    SdfOptions options;
    options.threads = threads;
    ProbabilisticSdf sdf(options);
    for (std::size_t k = 0; k < frames.size(); ++k) {
      sdf.integrate(frames[k], k % 2 ? biased : camera, FrameUncertainty::of_pose(0.0004, 0.001));
    }
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

/// What a frame is worked on in is kept for the next: of another size, with or without shared errors, it must not show.
TEST(ProbabilisticSdf, NothingIsLeftOfTheFrameBefore) {
  const DepthCamera whole = small_camera();
  DepthCamera half = whole;
  half.name = "half";
  half.systematic = 0.0005;
  half.intrinsics.width /= 2;
  half.intrinsics.height /= 2;
  half.intrinsics.cx -= half.intrinsics.width / 2.0;
  // A table that fills the image to its borders, and a ball on it.
  const std::vector<PlacedShape> scene = {{Box{{4, 4, 0.02}}, Pose(Eigen::Translation3d(0, 0, -0.01))},
                                          {Sphere{0.05}, Pose(Eigen::Translation3d(0, 0, 0.05))}};
  const auto frames = [&](const DepthCamera& camera) {
    std::vector<DepthImage> out;
    for (int k = 0; k < 4; ++k) {
      Rng rng(5, static_cast<std::uint64_t>(k));
      out.push_back(frame_of(scene, camera, look_at({0.1 * k, 0.1, 0.35}, {0, 0, 0})));
      disturb(out.back(), camera, rng);
    }
    return out;
  };
  const std::vector<DepthImage> large = frames(whole), small = frames(half);
  const auto map = [&](bool anew) {
    ProbabilisticSdf sdf;
    std::vector<ProbabilisticSdf>
        before;  // A map that is shared is copied before it changes, without what it worked in.
    const auto integrate = [&](const DepthImage& image, const DepthCamera& camera,
                               const FrameUncertainty& uncertainty) {
      if (anew) before.push_back(sdf);
      sdf.integrate(image, camera, uncertainty);
    };
    for (std::size_t k = 0; k < large.size(); ++k) {
      integrate(large[k], whole, FrameUncertainty::of_pose(0.0004, 0.001));
      integrate(small[k], half, {});
      integrate(large[k], whole, {});
    }
    return bytes_of(sdf);
  };
  EXPECT_EQ(map(false), map(true));
}

TEST(ProbabilisticSdf, PlaneSeenAtAnAngle) {
  for (const double tilt : {0.0, 0.4, 0.8}) {
    const DepthCamera camera = small_camera(0.002);
    const Vector3d normal(std::sin(tilt), 0, -std::cos(tilt));
    const double offset = normal.z() * 0.3;
    DepthImage image = wall(camera, 0);
    for (int v = 0; v < camera.intrinsics.height; ++v) {
      for (int u = 0; u < camera.intrinsics.width; ++u) {
        const Vector3d ray((u - 79.5) / 200, (v - 59.5) / 200, 1);
        const double z = offset / normal.dot(ray);
        image.depth[v * 160 + u] = z > 0.1 && z < 1 ? static_cast<float>(z) : 0.0f;
      }
    }
    ProbabilisticSdf sdf;
    sdf.integrate(image, camera);
    Rng rng(5);
    for (int k = 0; k < 500; ++k) {
      const Vector3d across(std::cos(tilt), 0, std::sin(tilt));
      // What voxels are updated, less a cell.
      const double reach = std::min(0.010 * std::cos(tilt), 0.0035 + 0.004 * std::cos(tilt)) - 0.0035;
      const double distance = rng.uniform(-reach, reach);
      const Vector3d p = Vector3d(0, 0, 0.3) + rng.uniform(-0.04, 0.04) * across +
                         rng.uniform(-0.04, 0.04) * Vector3d::UnitY() + distance * normal;
      const SdfValues at = sdf.query(p);
      ASSERT_TRUE(at.known[0]);
      EXPECT_NEAR(at.mean[0], distance, 2e-5) << tilt;
      // The depth's error along the ray moves the plane by its cosine; neighbouring voxels share pixels or not.
      const Vector3d ray(p.x() / p.z(), p.y() / p.z(), 1);
      EXPECT_LE(at.sigma[0], 1.02 * 0.002 * std::abs(normal.dot(ray)));
      EXPECT_GE(at.sigma[0], 0.3 * 0.002 * std::abs(normal.dot(ray)));
    }
    const SdfValues voxel = sdf.query(Vector3d(0, 0, 0.3));  // no interpolation here
    EXPECT_NEAR(voxel.sigma[0], 0.002 * std::cos(tilt), 2e-5);
  }
}

TEST(ProbabilisticSdf, AlongTheRayAsInThePaper) {
  SdfOptions options;
  options.distance = SdfDistance::along_ray;
  ProbabilisticSdf sdf(options);
  const DepthCamera camera = small_camera(0.002);
  sdf.integrate(wall(camera, 0.3), camera);
  // (4.12) with custom's sign: z* - d(v, c), both along the ray.
  const Vector3d voxel(0.06, 0.04, 0.296);
  const double stretch = voxel.norm() / voxel.z();
  const SdfValues at = sdf.query(voxel);
  EXPECT_NEAR(at.mean[0], 0.004 * stretch, 2e-5);
  EXPECT_NEAR(at.sigma[0], 0.002 * stretch, 2e-5);
}

TEST(ProbabilisticSdf, HiddenIsUnknownAndInFrontIsPositive) {
  ProbabilisticSdf sdf;
  const DepthCamera camera = small_camera();
  sdf.integrate(wall(camera, 0.3), camera);
  EXPECT_GT(sdf.query(Vector3d(0, 0, 0.297)).mean[0], 0);
  EXPECT_LT(sdf.query(Vector3d(0, 0, 0.303)).mean[0], 0);
  for (const double z : {0.309, 0.33, 0.6, -0.3}) {
    const SdfValues behind = sdf.query(Vector3d(0, 0, z));
    EXPECT_FALSE(behind.known[0]) << z;
    EXPECT_TRUE(std::isnan(behind.mean[0]) && std::isnan(behind.sigma[0]));
  }
  EXPECT_FALSE(sdf.query(Vector3d(0.2, 0, 0.3)).known[0]);  // beside the image
}

TEST(ProbabilisticSdf, WhatIsGoneIsCarved) {
  const DepthCamera camera = small_camera();
  const PlacedShape floor{Box{{0.4, 0.4, 0.02}}, Pose(Eigen::Translation3d(0, 0, -0.01))};
  const PlacedShape box{Box{{0.04, 0.04, 0.04}}, Pose(Eigen::Translation3d(0, 0, 0.02))};
  const Pose eyes[] = {look_at({0, 0, 0.35}, {0, 0, 0}), look_at({0.15, 0, 0.3}, {0, 0, 0}),
                       look_at({-0.1, 0.1, 0.3}, {0, 0, 0})};
  ProbabilisticSdf sdf;
  const Vector3d inside_top(0.002, 0.003, 0.036);
  for (const Pose& eye : eyes) sdf.integrate(frame_of({floor, box}, camera, eye), camera);
  EXPECT_LT(sdf.query(inside_top).mean[0], 0);
  const Matrix3Xd down = Vector3d(0, 0, -1), from = Vector3d(0.004, 0.004, 0.2);
  EXPECT_NEAR(sdf.cast_rays(from, down).point(2, 0), 0.04, 1e-4);
  for (const Pose& eye : eyes) sdf.integrate(frame_of({floor}, camera, eye), camera);
  EXPECT_LT(sdf.query(inside_top).mean[0], 0);  // three frames against three
  sdf.integrate(frame_of({floor}, camera, eyes[0]), camera);
  EXPECT_GT(sdf.query(inside_top).mean[0], 0);
  EXPECT_TRUE(sdf.query(inside_top).known[0]);
  EXPECT_NEAR(sdf.cast_rays(from, down).point(2, 0), 0, 1e-4);
}

TEST(ProbabilisticSdf, SphereSeenAllAround) {
  const double radius = 0.05;
  const DepthCamera camera = small_camera();
  ProbabilisticSdf sdf;
  for (int k = 0; k < 20; ++k) {
    sdf.integrate(frame_of({{Sphere{radius}}}, camera, look_at(0.3 * direction_of(k, 20), {0, 0, 0})), camera);
  }
  const SdfMesh mesh = sdf.mesh();
  Monitor stopped;
  stopped.stop.stop();
  EXPECT_TRUE(sdf.mesh(stopped).mesh->triangles.empty());
  EXPECT_EQ(sdf.points(stopped).point.cols(), 0);
  EXPECT_TRUE(mesh.mesh->closed);
  EXPECT_EQ(mesh.sigma.size(), mesh.mesh->vertices.size());
  EXPECT_NEAR(mesh_volume(*mesh.mesh), 4 * M_PI / 3 * radius * radius * radius, 0.01 * 5.236e-4);
  for (std::size_t i = 0; i < mesh.sigma.size(); ++i) {
    EXPECT_NEAR(mesh.mesh->vertices[i].norm(), radius, 2.5e-4);
    EXPECT_GT(mesh.sigma[i], 0.001 / std::sqrt(20.0) * 0.3);
    EXPECT_LT(mesh.sigma[i], 0.001);
  }
  const SdfPoints points = sdf.points();
  for (Eigen::Index i = 0; i < points.point.cols(); ++i) {
    EXPECT_GT(points.normal.col(i).dot(points.point.col(i).normalized()), 0.95);
  }
  Rng rng(1);
  for (int k = 0; k < 2000; ++k) {
    const Vector3d p = rng.uniform(radius - 0.0015, radius + 0.0015) * direction_of(k, 2000);
    const SdfValues at = sdf.query(p);
    ASSERT_TRUE(at.known[0]);
    EXPECT_NEAR(at.mean[0], p.norm() - radius, 4e-4);
  }
}

TEST(ProbabilisticSdf, RaysMeetWhatTheRayCasterMeets) {
  const auto shape = shape_mesh(Cylinder{0.04, 0.08}, 60);
  const RayCaster truth(*shape);
  const DepthCamera camera = small_camera();
  ProbabilisticSdf sdf;
  for (int k = 0; k < 20; ++k) {
    sdf.integrate(frame_of({{MeshShape{shape}}}, camera, look_at(0.3 * direction_of(k, 20), {0, 0, 0})), camera);
  }
  Rng rng(2);
  const int count = 3000;
  Matrix3Xd origins(3, count), directions(3, count);
  for (int k = 0; k < count; ++k) {
    origins.col(k) = rng.uniform(0.2, 3.0) * direction_of(k, count);
    const Vector3d target(rng.uniform(-0.04, 0.04), rng.uniform(-0.04, 0.04), rng.uniform(-0.05, 0.05));
    directions.col(k) = rng.uniform(0.1, 3) * (target - origins.col(k));
  }
  const SdfHits hits = sdf.cast_rays(origins, directions);
  int both = 0, differ = 0, steep = 0;
  for (int k = 0; k < count; ++k) {
    const RayHit hit = truth.closest_hit({origins.col(k), directions.col(k)});
    differ += static_cast<bool>(hit) != static_cast<bool>(hits.hit[k]);
    if (!hit || !hits.hit[k]) continue;
    ++both;
    EXPECT_NEAR((origins.col(k) + hits.distance[k] * directions.col(k) - hits.point.col(k)).norm(), 0, 1e-12);
    EXPECT_NEAR(hits.normal.col(k).norm(), 1, 1e-9);
    EXPECT_GT(hits.sigma[k], 0);
    // Rims are rounded by about a voxel.
    const double error = std::abs((hits.point.col(k) - hit.point).dot(hit.normal));
    steep += error > 0.5e-3 || hits.normal.col(k).dot(hit.normal) < 0.9;
    EXPECT_LT(error, 4e-3);
  }
  EXPECT_GT(both, 2000);
  EXPECT_LT(differ, count / 50);
  EXPECT_LT(steep, both / 6);
  // From inside nothing is met: surfaces are met from the front.
  EXPECT_FALSE(sdf.cast_rays(Vector3d::Zero(), Vector3d::UnitX()).hit[0]);
}

TEST(ProbabilisticSdf, TwoSensorsOfDifferentNoise) {
  DepthCamera fine = small_camera(0.0005), coarse = small_camera(0.002);
  fine.name = "fine";
  coarse.name = "coarse";
  const Vector3d voxel(0, 0, 0.3);
  {
    ProbabilisticSdf sdf;
    sdf.integrate(wall(fine, 0.301), fine);
    sdf.integrate(wall(coarse, 0.304), coarse);
    const double w1 = 1 / (0.0005 * 0.0005), w2 = 1 / (0.002 * 0.002);
    EXPECT_NEAR(sdf.query(voxel).mean[0], (w1 * 0.001 + w2 * 0.004) / (w1 + w2), 1e-7);
    EXPECT_NEAR(sdf.query(voxel).sigma[0], 1 / std::sqrt(w1 + w2), 1e-8);
  }
  // With systematic errors: generalised least squares, all frames of a camera sharing one unknown offset.
  fine.systematic = 0.001;
  coarse.systematic = 0.0004;
  coarse.systematic_scale = 0.001;
  ProbabilisticSdf sdf;
  std::vector<double> z, variance, shared;
  std::vector<int> owner;
  for (int k = 0; k < 12; ++k) {
    const DepthCamera& camera = k % 3 ? coarse : fine;
    z.push_back(0.3 + 0.0007 * std::sin(5.0 * k));
    variance.push_back(std::pow(camera.noise.constant, 2));
    shared.push_back(std::pow(camera.systematic, 2) + std::pow(camera.systematic_scale * 0.3, 2));
    owner.push_back(k % 3 ? 1 : 0);
    sdf.integrate(wall(camera, z.back()), camera);
  }
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(12, 12);
  for (int i = 0; i < 12; ++i) {
    for (int j = 0; j < 12; ++j) C(i, j) = (i == j ? variance[i] : 0) + (owner[i] == owner[j] ? shared[i] : 0);
  }
  const Eigen::VectorXd weights = C.ldlt().solve(Eigen::VectorXd::Ones(12));
  const Eigen::VectorXd distances = Eigen::Map<Eigen::VectorXd>(z.data(), 12).array() - 0.3;
  EXPECT_NEAR(sdf.query(voxel).mean[0], weights.dot(distances) / weights.sum(), 2e-6);
  EXPECT_NEAR(sdf.query(voxel).sigma[0], 1 / std::sqrt(weights.sum()), 1e-6);
}

TEST(ProbabilisticSdf, AThousandFramesDoNotMakeFalseCertainty) {
  DepthCamera camera = small_camera(0.001);
  camera.intrinsics.width = camera.intrinsics.height = 16;
  camera.intrinsics.cx = camera.intrinsics.cy = 7.5;
  camera.systematic = 0.0008;
  ProbabilisticSdf sdf;
  for (int k = 0; k < 1000; ++k) sdf.integrate(wall(camera, 0.3), camera);
  EXPECT_NEAR(sdf.query(Vector3d(0, 0, 0.3)).sigma[0], std::hypot(0.0008, 0.001 / std::sqrt(1000.0)), 1e-6);
}

TEST(ProbabilisticSdf, PoseErrorsAddInClosedForm) {
  const DepthCamera camera = small_camera(0.001);
  ProbabilisticSdf sdf;
  sdf.integrate(wall(camera, 0.3), camera, FrameUncertainty::of_pose(0.002, 0.01));
  // At p on a wall across the axis: displacement along z, rotation about x and y by the arms y and x.
  const Vector3d p(0.06, -0.03, 0.3);
  const double variance = 1e-6 + 4e-6 + 1e-4 * (0.06 * 0.06 + 0.03 * 0.03);
  EXPECT_NEAR(sdf.query(p).sigma[0], std::sqrt(variance), 0.01 * std::sqrt(variance));
}

TEST(ProbabilisticSdf, AnImageOfSigmas) {
  const DepthCamera camera = small_camera(0.001);
  FrameUncertainty uncertainty;
  uncertainty.sigma.assign(160 * 120, 0.0005f);
  for (int v = 0; v < 120; ++v) {
    for (int u = 80; u < 160; ++u) uncertainty.sigma[v * 160 + u] = 0.0025f;
  }
  ProbabilisticSdf sdf;
  sdf.integrate(wall(camera, 0.3), camera, uncertainty);
  EXPECT_NEAR(sdf.query(Vector3d(-0.02, 0, 0.3)).sigma[0], 0.0005, 1e-7);
  EXPECT_NEAR(sdf.query(Vector3d(0.02, 0, 0.3)).sigma[0], 0.0025, 1e-7);
}

TEST(ProbabilisticSdf, CopiesAndFieldsKeepWhatTheyHad) {
  const DepthCamera camera = small_camera();
  ProbabilisticSdf sdf;
  sdf.integrate(wall(camera, 0.3), camera);
  const ProbabilisticSdf copy = sdf;
  const auto field = sdf.distance_field(0);
  sdf.integrate(wall(camera, 0.302), camera);
  const Vector3d voxel(0, 0, 0.3);
  EXPECT_NEAR(copy.query(voxel).mean[0], 0, 1e-7);
  EXPECT_NEAR(field->distance(voxel), 0, 1e-7);
  EXPECT_NEAR(sdf.query(voxel).mean[0], 0.001, 1e-7);
}

TEST(ProbabilisticSdf, DistanceFieldTakesItsMargin) {
  const DepthCamera camera = small_camera(0.001);
  ProbabilisticSdf sdf;
  sdf.integrate(wall(camera, 0.3), camera);
  const Vector3d near(0.01, 0.004, 0.296), far(0, 0, 2);
  const SdfValues at = sdf.query(near);
  for (const double sigmas : {0.0, 2.0, 3.0}) {
    Matrix3Xd gradients;
    const Eigen::VectorXd d = sdf.distance_field(sigmas)->distances(near, gradients);
    EXPECT_NEAR(d[0], at.mean[0] - sigmas * at.sigma[0], 1e-9);
    EXPECT_NEAR((gradients.col(0) - Vector3d(0, 0, -1)).norm(), 0, 1e-3);
  }
  EXPECT_TRUE(std::isnan(sdf.distance_field()->distance(far)));
  EXPECT_EQ(sdf.distance_field(2, UnknownSpace::free)->distance(far), 0.010);
  EXPECT_EQ(sdf.distance_field(2, UnknownSpace::occupied)->distance(far), -0.010);
  EXPECT_FALSE(sdf.distance_field()->properties().domain.contains(far));
  EXPECT_EQ(sdf.distance_field()->properties().truncation, 0.010);
  EXPECT_THROW(sdf.distance_field(-1), InvalidInput);
}

/// Many points are sorted by block, fewer are worked on in groups, one is looked up alone: each has the same bits, on
/// the borders of blocks, where the map ends and far from it, with one layer and with two, carved or not.
TEST(ProbabilisticSdf, EmptyMapsAnswer) {
  const ProbabilisticSdf sdf;
  EXPECT_FALSE(sdf.query(Vector3d(0, 0, 0)).known[0]);
  EXPECT_FALSE(sdf.cast_rays(Vector3d::Zero(), Vector3d::UnitX()).hit[0]);
  EXPECT_TRUE(sdf.mesh().mesh->triangles.empty());
  EXPECT_EQ(sdf.points().point.cols(), 0);
  EXPECT_TRUE(sdf.bounds().isEmpty());
  EXPECT_EQ(sdf.query(Matrix3Xd(3, 0)).mean.size(), 0);
  EXPECT_EQ(sdf.cropped({Vector3d(0, 0, 0), Vector3d(1, 1, 1)}).blocks(), 0u);
}
