#include "mmgrasp/mapping/frame_registration.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "mapping/sdf_scenes.hpp"
#include "mmgrasp/core/error.hpp"

using namespace mmgrasp;
using namespace mmgrasp::test;
using Eigen::Vector3d;
using Vector6 = Eigen::Matrix<double, 6, 1>;

namespace {

constexpr double kCentimetre = 0.01, kDegree = M_PI / 180;

std::vector<PlacedShape> table_with_parts() {
  return {{Box{{0.5, 0.5, 0.02}}, Pose(Eigen::Translation3d(0, 0, -0.01))},
          {Box{{0.06, 0.04, 0.05}}, Pose(Eigen::Translation3d(0.05, 0.02, 0.025))},
          {Cylinder{0.025, 0.08}, Pose(Eigen::Translation3d(-0.05, -0.02, 0.04))},
          {Sphere{0.03}, Pose(Eigen::Translation3d(0.02, -0.07, 0.03))}};
}

Pose eye_of(int k, int count) {
  const double angle = 2 * M_PI * k / count, height = 0.20 + 0.05 * (k % 3);
  return look_at({0.30 * std::cos(angle), 0.30 * std::sin(angle), height}, {0, 0, 0.02});
}

Vector3d normals(Rng& rng) {
  const double x = rng.normal(), y = rng.normal();
  return {x, y, rng.normal()};
}

/// A pose off by an error of these standard deviations along each axis.
Pose off(const Pose& T, double translation, double rotation, Rng& rng) {
  Pose out = T;
  const Vector3d turn = rotation * normals(rng), shift = translation * normals(rng);
  if (turn.norm() > 0) out.linear() = Eigen::AngleAxisd(turn.norm(), turn.normalized()).matrix() * T.linear();
  out.translation() += shift;
  return out;
}

/// Displacement and rotation vector that lead from `b` to `a`, as in FrameUncertainty.
Vector6 difference(const Pose& a, const Pose& b) {
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(a.linear() * b.linear().transpose()));
  Vector6 out;
  out << a.translation() - b.translation(), turn.angle() * turn.axis();
  return out;
}

DepthImage noisy(const std::vector<PlacedShape>& scene, const DepthCamera& camera, const Pose& T, Rng& rng) {
  DepthImage image = frame_of(scene, camera, T);
  disturb(image, camera, rng);
  return image;
}

FrameUncertainty with(const Eigen::Matrix<double, 6, 6>& covariance) {
  FrameUncertainty out;
  out.pose_covariance = covariance;
  return out;
}

ProbabilisticSdf map_of(const std::vector<PlacedShape>& scene, const DepthCamera& camera, int frames) {
  ProbabilisticSdf sdf;
  for (int k = 0; k < frames; ++k) {
    Rng rng(3, static_cast<std::uint64_t>(k));
    sdf.integrate(noisy(scene, camera, eye_of(k, frames), rng), camera);
  }
  return sdf;
}

}  // namespace

/// Poses off by 1 cm and 1 degree along each axis, against a map of exact poses.
TEST(FrameRegistration, PoseErrorsAreReduced) {
  const DepthCamera camera = small_camera(0.001);
  const ProbabilisticSdf sdf = map_of(table_with_parts(), camera, 12);
  Vector6 before = Vector6::Zero(), after = Vector6::Zero();
  double surprise = 0;
  int registered = 0;
  const int trials = 40;
  for (int k = 0; k < trials; ++k) {
    Rng rng(11, static_cast<std::uint64_t>(k));
    const Pose truth = eye_of(2 * k + 1, 2 * trials);
    DepthImage image = noisy(table_with_parts(), camera, truth, rng);
    image.T_world_camera = off(truth, kCentimetre, kDegree, rng);
    const FrameRegistration found = register_frame(sdf, image, camera, FrameUncertainty::of_pose(kCentimetre, kDegree));
    if (!found.registered) {
      std::printf("frame %d: %s\n", k, found.reason.c_str());
      continue;
    }
    ++registered;
    EXPECT_GE(found.observed, 5);
    const Vector6 was = difference(image.T_world_camera, truth), is = difference(found.T_world_camera, truth);
    before += was.cwiseAbs2();
    after += is.cwiseAbs2();
    surprise += is.dot(found.covariance.ldlt().solve(is)) / 6;
    EXPECT_LT(found.rms, 0.003);
  }
  EXPECT_GE(registered, trials - 1);
  const auto rms = [&](const Vector6& sum, int first) { return std::sqrt(sum.segment<3>(first).mean() / registered); };
  std::printf(
      "translation %.2f to %.3f mm, rotation %.3f to %.4f degrees an axis; squared errors over covariance %.2f\n",
      1e3 * rms(before, 0), 1e3 * rms(after, 0), rms(before, 3) / kDegree, rms(after, 3) / kDegree,
      surprise / registered);
  EXPECT_LT(rms(after, 0), 0.0006);
  EXPECT_LT(rms(after, 3), 0.15 * kDegree);
  EXPECT_LT(surprise / registered, 3);
  EXPECT_GT(surprise / registered, 0.2);
}

/// Maps of a scan whose first pose is exact and whose others are not, with and without registration, and of exact
/// poses.
TEST(FrameRegistration, MapsOfRegisteredFramesAreBetter) {
  const auto scene = table_with_parts();
  const DepthCamera camera = small_camera(0.001);
  for (const int frames : {20, 40}) {
    double within[3] = {}, squares[3] = {}, known[3] = {};  // as given, registered, exact poses
    double surprise = 0, refused = 0;
    const int trials = frames == 20 ? 4 : 2;
    for (int trial = 0; trial < trials; ++trial) {
      ProbabilisticSdf raw, registered, exact;
      for (int k = 0; k < frames; ++k) {
        Rng rng(31 + trial, static_cast<std::uint64_t>(k));
        const Pose truth = eye_of(k, frames);
        DepthImage image = noisy(scene, camera, truth, rng);
        exact.integrate(image, camera);
        const FrameUncertainty given = k == 0 ? FrameUncertainty{} : FrameUncertainty::of_pose(kCentimetre, kDegree);
        if (k > 0) image.T_world_camera = off(truth, kCentimetre, kDegree, rng);
        raw.integrate(image, camera, given);
        if (k > 0) {
          const FrameRegistration found = register_frame(registered, image, camera, given);
          const Vector6 is = difference(found.T_world_camera, truth);
          refused += !found.registered;
          surprise += is.dot(found.covariance.ldlt().solve(is)) / 6 / (frames - 1);
          image.T_world_camera = found.T_world_camera;
          registered.integrate(image, camera, with(found.covariance));
        } else {
          registered.integrate(image, camera, given);
        }
      }
      // The truth under pixels of exact views.
      for (int k = 0; k < 12; ++k) {
        const DepthImage seen = frame_of(scene, camera, eye_of(k, 12));
        Eigen::Matrix3Xd points(3, 0);
        std::vector<Vector3d> some;
        for (int v = 2; v < 120; v += 5) {
          for (int u = 2; u < 160; u += 5) {
            if (seen.at(u, v) > 0) some.push_back(seen.point(u, v));
          }
        }
        points.resize(3, some.size());
        for (std::size_t i = 0; i < some.size(); ++i) points.col(i) = some[i];
        for (const int which : {0, 1, 2}) {
          const SdfValues at = (which == 0 ? raw : which == 1 ? registered : exact).query(points);
          for (std::size_t i = 0; i < some.size(); ++i) {
            if (!at.known[i]) continue;
            known[which] += 1;
            squares[which] += at.mean[i] * at.mean[i];
            within[which] += std::abs(at.mean[i]) <= 1.96 * at.sigma[i];
          }
        }
      }
    }
    std::printf("%2d frames: squared errors over covariance %.2f, %.0f refused\n", frames, surprise / trials, refused);
    for (const int which : {0, 1, 2}) {
      std::printf("%2d frames, %s: rms %.3f mm, %.4f within 1.96 sigma\n", frames,
                  which == 0   ? "as given"
                  : which == 1 ? "registered"
                               : "exact poses",
                  1e3 * std::sqrt(squares[which] / known[which]), within[which] / known[which]);
    }
    EXPECT_LT(std::sqrt(squares[1] / known[1]), 0.5 * std::sqrt(squares[0] / known[0]));
    EXPECT_NEAR(within[2] / known[2], 0.95, 0.02);
    // Short of that: what a registered frame is wrong by, it has from the frames before it, and passes on.
    EXPECT_GT(within[1] / known[1], 0.80);
  }
}

TEST(FrameRegistration, APlaneAloneDoesNotLetItSlide) {
  const std::vector<PlacedShape> plane{{Plane{Vector3d::UnitZ(), 0.0}, Pose::Identity()}};
  const DepthCamera camera = small_camera(0.001);
  const ProbabilisticSdf sdf = map_of(plane, camera, 8);
  for (int k = 0; k < 10; ++k) {
    Rng rng(41, static_cast<std::uint64_t>(k));
    const Pose truth = eye_of(k, 10);
    DepthImage image = noisy(plane, camera, truth, rng);
    image.T_world_camera = off(truth, kCentimetre, kDegree, rng);
    const FrameUncertainty given = FrameUncertainty::of_pose(kCentimetre, kDegree);
    const FrameRegistration found = register_frame(sdf, image, camera, given);
    ASSERT_TRUE(found.registered) << found.reason;
    EXPECT_EQ(found.observed, 3);
    // Height and tilt come from the plane. Where the camera stands over it, and its turn about the normal, are as
    // given.
    const Vector6 change = difference(found.T_world_camera, image.T_world_camera);
    EXPECT_LT(change.head<2>().norm(), 0.0003);
    EXPECT_LT(std::abs(change[5]), 0.02 * kDegree + 0.02 * change.segment<2>(3).norm());
    const Vector3d middle = frame_of(plane, camera, truth).point(80, 60);
    const Vector3d on_plane = found.T_world_camera * (truth.inverse() * middle);
    EXPECT_LT(std::abs(on_plane.z()), 0.0005);
    // There the covariance is still the given one.
    for (const int k : {0, 1, 5}) EXPECT_GT(found.covariance(k, k), 0.95 * given.pose_covariance(k, k));
    EXPECT_LT(found.covariance(2, 2), 0.2 * given.pose_covariance(2, 2));
  }
}

TEST(FrameRegistration, ABallFixesNoTurn) {
  const std::vector<PlacedShape> ball{{Sphere{0.05}, Pose::Identity()}};
  const DepthCamera camera = small_camera(0.001);
  const ProbabilisticSdf sdf = map_of(ball, camera, 20);
  Rng rng(5);
  const Pose truth = eye_of(1, 7);
  DepthImage image = noisy(ball, camera, truth, rng);
  image.T_world_camera.translation() += Vector3d(0.004, -0.003, 0.005);
  const FrameRegistration found = register_frame(sdf, image, camera, FrameUncertainty::of_pose(kCentimetre, kDegree));
  ASSERT_TRUE(found.registered) << found.reason;
  EXPECT_EQ(found.observed, 3);
  // The ball's middle is found whatever turns about it.
  const Vector3d middle = found.T_world_camera * (truth.inverse() * Vector3d::Zero());
  EXPECT_LT(middle.norm(), 0.0006);
}

TEST(FrameRegistration, WrongPixelsDoNotCount) {
  const DepthCamera camera = small_camera(0.001);
  const ProbabilisticSdf sdf = map_of(table_with_parts(), camera, 12);
  // A box that the map does not know hides part of the view, and one pixel in fifty says anything.
  auto scene = table_with_parts();
  scene.push_back({Box{{0.05, 0.05, 0.06}}, Pose(Eigen::Translation3d(0.0, 0.07, 0.03))});
  Vector6 errors = Vector6::Zero();
  for (int k = 0; k < 6; ++k) {
    Rng rng(61, static_cast<std::uint64_t>(k));
    const Pose truth = eye_of(2 * k + 1, 12);
    DepthImage image = noisy(scene, camera, truth, rng);
    for (float& z : image.depth) {
      if (rng.uniform() < 0.02) z = static_cast<float>(rng.uniform(0.2, 0.6));
    }
    image.T_world_camera = off(truth, 0.5 * kCentimetre, 0.5 * kDegree, rng);
    const FrameRegistration found =
        register_frame(sdf, image, camera, FrameUncertainty::of_pose(0.5 * kCentimetre, 0.5 * kDegree));
    ASSERT_TRUE(found.registered) << found.reason;
    const Vector6 is = difference(found.T_world_camera, truth);
    errors += is.cwiseAbs2() / 6;
  }
  std::printf("translation %.2f mm, rotation %.3f degrees an axis\n", 1e3 * std::sqrt(errors.head<3>().mean()),
              std::sqrt(errors.tail<3>().mean()) / kDegree);
  EXPECT_LT(std::sqrt(errors.head<3>().mean()), 0.0015);
  EXPECT_LT(std::sqrt(errors.tail<3>().mean()), 0.3 * kDegree);
}

TEST(FrameRegistration, IsTheSameAtAnyThreadCount) {
  const DepthCamera camera = small_camera(0.001);
  const ProbabilisticSdf sdf = map_of(table_with_parts(), camera, 6);
  Rng rng(2);
  DepthImage image = noisy(table_with_parts(), camera, eye_of(3, 8), rng);
  image.T_world_camera = off(image.T_world_camera, kCentimetre, kDegree, rng);
  RegistrationOptions options;
  options.threads = 1;
  const FrameUncertainty given = FrameUncertainty::of_pose(kCentimetre, kDegree);
  const FrameRegistration one = register_frame(sdf, image, camera, given, options);
  ASSERT_TRUE(one.registered);
  for (const int threads : {2, 5}) {
    options.threads = threads;
    const FrameRegistration other = register_frame(sdf, image, camera, given, options);
    EXPECT_EQ(other.T_world_camera.matrix(), one.T_world_camera.matrix());
    EXPECT_EQ(other.covariance, one.covariance);
  }
}

TEST(FrameRegistration, RefusesWhatDoesNotFit) {
  const DepthCamera camera = small_camera(0.001);
  const ProbabilisticSdf sdf = map_of(table_with_parts(), camera, 6);
  const FrameUncertainty given = FrameUncertainty::of_pose(kCentimetre, kDegree);
  Rng rng(2);
  DepthImage image = noisy(table_with_parts(), camera, eye_of(3, 8), rng);
  const Pose truth = image.T_world_camera;
  // Looks elsewhere.
  image.T_world_camera.translation() += Vector3d(2, 0, 0);
  FrameRegistration found = register_frame(sdf, image, camera, given);
  EXPECT_FALSE(found.registered);
  EXPECT_NE(found.reason.find("meet the map's surface"), std::string::npos) << found.reason;
  EXPECT_EQ(found.T_world_camera.matrix(), image.T_world_camera.matrix());
  EXPECT_EQ(found.covariance, given.pose_covariance);
  // Farther off than it may be.
  image.T_world_camera = truth;
  image.T_world_camera.translation() += Vector3d(0, 0, 0.008);
  found = register_frame(sdf, image, camera, FrameUncertainty::of_pose(0.001, 0.001));
  EXPECT_FALSE(found.registered);
  EXPECT_NE(found.reason.find("standard deviations from the given one"), std::string::npos) << found.reason;
  // Not given the time.
  RegistrationOptions options;
  options.max_iterations = 1;
  found = register_frame(sdf, image, camera, given, options);
  EXPECT_FALSE(found.registered);
  EXPECT_NE(found.reason.find("in 1 iterations"), std::string::npos) << found.reason;
  // Misuse.
  EXPECT_THROW(register_frame(sdf, image, camera, {}), InvalidInput);
  EXPECT_THROW(register_frame(ProbabilisticSdf{}, image, camera, given), InvalidInput);
  options.max_iterations = 0;
  EXPECT_THROW(register_frame(sdf, image, camera, given, options), InvalidInput);
}
