#include "mmgrasp/mapping/segment_objects.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <set>
#include <thread>
#include <tuple>
#include <variant>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/mapping/depth_image.hpp"

using namespace mmgrasp;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;

namespace {

const Matrix3Xd kNoNormals(3, 0);
/// Depth noise at 1 m of the noisy scenes [m].
constexpr double kNoise = 0.001;
/// As near as this to another object normals are those of both: their windows are three cells wide [m].
constexpr double kContact = 0.012;

/// An upright box or a ball on or over the table z = 0.
struct Body {
  Shape shape;
  Vector3d centre;
  double distance(const Vector3d& p) const {  ///< Of a point from its surface, positive outside [m].
    const Vector3d off = p - centre;
    if (const auto* ball = std::get_if<Sphere>(&shape)) return off.norm() - ball->radius;
    const Vector3d q = off.cwiseAbs() - std::get<Box>(shape).size / 2;
    return q.cwiseMax(0).norm() + std::min(q.maxCoeff(), 0.0);
  }
};

Body box(const Vector3d& size, double x, double y, double bottom = 0) {
  return {Box{size}, {x, y, bottom + size.z() / 2}};
}

/// From the front (-y), the right and above, 0.7 m away.
Pose camera_pose() {
  return Pose(Eigen::AngleAxisd(0.35, Vector3d::UnitZ())) * Pose(Eigen::AngleAxisd(0.75, Vector3d::UnitX())) *
         look_down({0, 0, 0.7});
}

DepthImage seen(const std::vector<Body>& bodies, double noise = 0, unsigned seed = 1) {
  std::vector<PlacedShape> scene{{Plane{Vector3d::UnitZ(), 0.0}, Pose::Identity()}};
  for (const Body& body : bodies) scene.push_back({body.shape, Pose(Eigen::Translation3d(body.centre))});
  PinholeCamera camera;
  camera.farthest = 1.2;
  RenderOptions options;
  options.noise = noise;
  options.seed = seed;
  return render_depth(scene, camera, camera_pose(), options);
}

/// Each body is one object, which has all of the body's points, or that `share` of them, that are neither at the table
/// nor within `contact` [m] of another body.
void expect_bodies(const std::vector<Body>& bodies, const DepthImage& image, const ObjectSegmentation& found,
                   double contact, double share = 1) {
  ASSERT_TRUE(found.plane.has_value());
  EXPECT_GT(found.plane->normal.z(), 1 - 1e-4);
  EXPECT_NEAR(found.plane->offset, 0, 1e-3);
  ASSERT_EQ(found.objects.size(), bodies.size());
  EXPECT_TRUE(found.warning.empty()) << found.warning;
  std::vector<std::map<int, int>> labels(bodies.size());  // with their number
  const double clear_of_table = ObjectSegmentationOptions().plane_tolerance + 0.003;
  for (int i = 0; i < static_cast<int>(image.depth.size()); ++i) {
    if (!(image.depth[i] > 0)) continue;
    const Vector3d p = image.point(i % image.camera.width, i / image.camera.width);
    std::vector<std::pair<double, std::size_t>> near;
    for (std::size_t b = 0; b < bodies.size(); ++b) near.emplace_back(std::abs(bodies[b].distance(p)), b);
    std::sort(near.begin(), near.end());
    if (p.z() < clear_of_table || near[0].first > 0.004) continue;
    if (near.size() > 1 && near[1].first < contact) continue;
    ++labels[near[0].second][found.labels[i]];
  }
  std::set<int> all;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    int points = 0, most = 0, main = -2;
    for (const auto& [label, number] : labels[b]) {
      points += number;
      if (number > most) std::tie(main, most) = std::make_pair(label, number);
    }
    EXPECT_GT(points, 100) << "body " << b;
    EXPECT_GE(main, 0) << "body " << b;
    EXPECT_GE(most, share * points) << "body " << b;
    all.insert(main);
  }
  EXPECT_EQ(all.size(), bodies.size());
}

void expect_parted(const std::vector<Body>& bodies, double share = 1) {
  const DepthImage exact = seen(bodies);
  expect_bodies(bodies, exact, segment_depth_image(exact), kContact, share);
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const DepthImage noisy = seen(bodies, kNoise, seed);
    expect_bodies(bodies, noisy, segment_depth_image(noisy), kContact + 4 * kNoise, share);
  }
}

Matrix3Xd columns(const std::vector<Vector3d>& points) {
  Matrix3Xd out(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) out.col(static_cast<Eigen::Index>(i)) = points[i];
  return out;
}

/// Points of a surface on all sides, 2 mm apart, with their normals, as maps give them.
struct Surface {
  std::vector<Vector3d> points, normals;

  void rectangle(const Vector3d& corner, const Vector3d& a, const Vector3d& b, const Eigen::AlignedBox3d& hidden = {}) {
    const Vector3d normal = a.cross(b).normalized();
    const int rows = static_cast<int>(a.norm() / 0.002), columns = static_cast<int>(b.norm() / 0.002);
    for (int i = 0; i < rows; ++i) {
      for (int j = 0; j < columns; ++j) {
        const Vector3d p = corner + (i + 0.5) / rows * a + (j + 0.5) / columns * b;
        if (hidden.contains(p)) continue;
        points.push_back(p);
        normals.push_back(normal);
      }
    }
  }
  /// The top and the four sides of a box from `low` to `high`, but for what is `hidden`.
  void box(const Vector3d& low, const Vector3d& high, const Eigen::AlignedBox3d& hidden = {}) {
    const Vector3d size = high - low;
    const Vector3d x = size.x() * Vector3d::UnitX(), y = size.y() * Vector3d::UnitY(), z = size.z() * Vector3d::UnitZ();
    rectangle(low + z, x, y, hidden);
    rectangle(low, x, z, hidden);
    rectangle(low + y, z, x, hidden);
    rectangle(low, z, y, hidden);
    rectangle(low + x, y, z, hidden);
  }
};

/// Of a body's labels the most frequent, with its share; `from` and `to` are the body's points.
std::pair<int, double> main_label(const std::vector<int>& labels, std::size_t from, std::size_t to) {
  std::map<int, std::size_t> count;
  for (std::size_t i = from; i < to; ++i) ++count[labels[i]];
  const auto most =
      std::max_element(count.begin(), count.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  return {most->first, static_cast<double>(most->second) / (to - from)};
}

std::vector<Vector3d> table(double half, double height = 0) {
  std::vector<Vector3d> points;
  for (double x = -half; x < half; x += 0.003) {
    for (double y = -half; y < half; y += 0.003) points.emplace_back(x, y, height);
  }
  return points;
}

}  // namespace

TEST(SegmentObjects, TwoBoxesSideBySide) {
  expect_parted({box({0.08, 0.08, 0.10}, -0.04, 0), box({0.08, 0.08, 0.06}, 0.04, 0.03)});
}

TEST(SegmentObjects, ABoxOnABox) {
  expect_parted({box({0.14, 0.12, 0.05}, 0, 0), box({0.08, 0.07, 0.06}, 0.01, 0.01, 0.05)});
}

TEST(SegmentObjects, ABallAtAWall) {
  expect_parted({box({0.20, 0.04, 0.15}, 0, 0.06), {Sphere{0.04}, {0, 0, 0.04}}});
}

TEST(SegmentObjects, ManyThatTouch) {
  expect_parted({box({0.12, 0.10, 0.05}, 0, 0),
                 box({0.05, 0.05, 0.05}, 0.01, 0.02, 0.05),
                 box({0.06, 0.06, 0.09}, -0.09, 0.01),
                 box({0.06, 0.05, 0.02}, 0.09, -0.02),
                 {Sphere{0.035}, {0, -0.085, 0.035}}},
                0.95);
}

TEST(SegmentObjects, ALoneObjectIsOne) {
  expect_parted({box({0.10, 0.07, 0.08}, 0, 0)});
  expect_parted({{Sphere{0.05}, {0, 0, 0.05}}});
}

/// What convexity does, and what it cannot know.
TEST(SegmentObjects, TheArmsOfAnLAreTwoAndFlushBoxesOne) {
  const std::vector<Body> bracket{box({0.10, 0.12, 0.03}, 0, 0), box({0.10, 0.03, 0.12}, 0, 0.075)};
  EXPECT_EQ(segment_depth_image(seen(bracket)).objects.size(), 2u);
  const std::vector<Body> flush{box({0.06, 0.08, 0.06}, -0.03, 0), box({0.06, 0.08, 0.06}, 0.03, 0)};
  EXPECT_EQ(segment_depth_image(seen(flush)).objects.size(), 1u);
}

/// All sides and their normals, as ProbabilisticSdf::points gives them: no eye sees all of it.
TEST(SegmentObjects, SurfacesFromAllSidesWithNormals) {
  Surface surface;
  surface.rectangle({-0.3, -0.3, 0}, {0.6, 0, 0}, {0, 0.6, 0});
  const std::size_t plane = surface.points.size();
  // Where they touch nothing can be seen.
  surface.box({-0.08, -0.04, 0}, {0, 0.04, 0.1},
              Eigen::AlignedBox3d(Vector3d(-1e-9, -0.02, 0), Vector3d(1, 0.06, 0.06)));
  const std::size_t first = surface.points.size();
  surface.box({0, -0.02, 0}, {0.08, 0.06, 0.06},
              Eigen::AlignedBox3d(Vector3d(-1, -0.04, 0), Vector3d(1e-9, 0.04, 0.1)));
  const ObjectSegmentation found = segment_objects(columns(surface.points), columns(surface.normals));
  ASSERT_EQ(found.objects.size(), 2u);
  EXPECT_GT(found.plane->normal.z(), 1 - 1e-6);
  EXPECT_GE(found.plane_inliers.size(), plane);
  // Of each box its 7 mm at the table are missing, and of the wall between them what lies inside.
  const auto [tall, share_tall] = main_label(found.labels, plane, first);
  const auto [low, share_low] = main_label(found.labels, first, surface.points.size());
  EXPECT_EQ(std::minmax(tall, low), std::minmax(0, 1));
  EXPECT_GT(share_tall, 0.85);
  EXPECT_GT(share_low, 0.80);
  const SegmentedObject& object = found.objects[tall];
  EXPECT_TRUE(
      object.bounds.isApprox(Eigen::AlignedBox3d(Vector3d(-0.08, -0.04, 0.007), Vector3d(0.005, 0.04, 0.1)), 0.05));
  EXPECT_TRUE(std::is_sorted(object.indices.begin(), object.indices.end()));
  for (const int i : object.indices) EXPECT_EQ(found.labels[i], tall);
}

TEST(SegmentObjects, NothingThereIsNoError) {
  for (const int n : {0, 1, 2, 3, 9}) {
    Matrix3Xd points = Matrix3Xd::Random(3, n);
    const ObjectSegmentation found = segment_objects(points);
    EXPECT_TRUE(found.objects.empty());
    EXPECT_EQ(found.labels.size(), n);
  }
  const ObjectSegmentation same = segment_objects(Matrix3Xd::Constant(3, 500, 0.25));
  EXPECT_TRUE(same.objects.empty());
  const ObjectSegmentation missing = segment_objects(Matrix3Xd::Constant(3, 500, NAN));
  EXPECT_FALSE(missing.plane.has_value());
  EXPECT_EQ(missing.labels, std::vector<int>(500, -2));
  const ObjectSegmentation bare = segment_objects(columns(table(0.2)), kNoNormals, {}, std::nullopt, {0, 0, 1});
  EXPECT_TRUE(bare.plane.has_value());
  EXPECT_TRUE(bare.objects.empty());
  EXPECT_EQ(bare.plane_inliers.size(), bare.labels.size());
}

TEST(SegmentObjects, NoPlaneNoObjects) {
  Rng rng(3);
  Matrix3Xd ball(3, 20000);
  for (Eigen::Index i = 0; i < ball.cols(); ++i) {
    ball.col(i) = 0.1 * Vector3d(rng.normal(), rng.normal(), rng.normal()).normalized();
  }
  const ObjectSegmentation found = segment_objects(ball);
  EXPECT_FALSE(found.plane.has_value());
  EXPECT_NE(found.warning.find("no plane"), std::string::npos);
  EXPECT_TRUE(found.objects.empty());
  EXPECT_TRUE(std::all_of(found.labels.begin(), found.labels.end(), [](int label) { return label == -2; }));
}

TEST(SegmentObjects, WhatIsNotMeasuredIsLeftOut) {
  const std::vector<Body> bodies{box({0.08, 0.08, 0.10}, 0, 0)};
  DepthImage image = seen(bodies);
  for (std::size_t i = 0; i < image.depth.size(); i += 7) image.depth[i] = 0;
  const ObjectSegmentation found = segment_depth_image(image);
  expect_bodies(bodies, image, found, kContact);
  for (std::size_t i = 0; i < image.depth.size(); i += 7) ASSERT_EQ(found.labels[i], -2);
}

/// The same as the image, as points with NaN, seen from the camera.
TEST(SegmentObjects, PointsAndImageAgree) {
  const DepthImage image = seen({box({0.08, 0.08, 0.10}, -0.04, 0), box({0.08, 0.08, 0.06}, 0.04, 0.03)}, kNoise);
  Matrix3Xd points = Matrix3Xd::Constant(3, static_cast<Eigen::Index>(image.depth.size()), NAN);
  for (int i = 0; i < points.cols(); ++i) {
    if (image.depth[i] > 0) points.col(i) = image.point(i % image.camera.width, i / image.camera.width);
  }
  const ObjectSegmentation from_points =
      segment_objects(points, kNoNormals, {}, std::nullopt, image.T_world_camera.translation());
  EXPECT_EQ(from_points.labels, segment_depth_image(image).labels);
}

TEST(SegmentObjects, TheSupportingPlaneIsTheOneWithMostAbove) {
  Surface room;
  room.rectangle({-0.5, -0.5, 1.5}, {0, 1.0, 0}, {1.0, 0, 0});  // a ceiling, larger than the table
  room.rectangle({-0.3, -0.3, 0}, {0.6, 0, 0}, {0, 0.6, 0});
  room.box({-0.05, -0.05, 0}, {0.05, 0.05, 0.1});
  room.box({0.5, 0.5, -0.6}, {0.55, 0.55, 0.2});                 // beside the table
  room.rectangle({-0.4, 0.42, -0.5}, {0.8, 0, 0}, {0, 0, 0.9});  // a wall behind it
  ObjectSegmentationOptions options;
  options.up = Vector3d::UnitZ();
  const Matrix3Xd points = columns(room.points), normals = columns(room.normals);
  const ObjectSegmentation found = segment_objects(points, normals, options);
  ASSERT_TRUE(found.plane.has_value());
  EXPECT_NEAR(found.plane->offset, 0, 1e-3);
  EXPECT_GT(found.plane->normal.z(), 1 - 1e-4);
  ASSERT_EQ(found.objects.size(), 1u);
  EXPECT_LT(found.objects[0].bounds.max().x(), 0.06);
  options.max_beside = 0.2;
  EXPECT_EQ(segment_objects(points, normals, options).objects.size(), 2u);
  // A plane that is given has no end.
  const ObjectSegmentation given = segment_objects(points, normals, options, SupportingPlane{Vector3d::UnitZ(), 0});
  EXPECT_EQ(given.objects.size(), 3u);
  const ObjectSegmentation raised = segment_objects(points, normals, options, SupportingPlane{Vector3d::UnitZ(), 0.15});
  ASSERT_EQ(raised.objects.size(), 2u);
  EXPECT_GT(raised.objects[0].bounds.min().y(), 0.29);
  EXPECT_GT(raised.objects[1].bounds.min().x(), 0.45);
}

/// A box whose top is larger than what is seen of the table.
TEST(SegmentObjects, TheTopOfALargeBoxSupportsNothing) {
  Surface scene;
  scene.rectangle({-0.25, -0.25, 0}, {0.5, 0, 0}, {0, 0.15, 0});
  scene.box({-0.25, -0.1, 0}, {0.25, 0.25, 0.1});
  const Matrix3Xd points = columns(scene.points), normals = columns(scene.normals);
  const ObjectSegmentation with_normals = segment_objects(points, normals);
  ASSERT_TRUE(with_normals.plane.has_value());
  // RANSAC may tilt the plane as far as the tolerance lets it.
  const Vector3d middle(0, -0.175, 0);
  EXPECT_NEAR(with_normals.plane->normal.dot(middle), with_normals.plane->offset, 0.007);
  EXPECT_GT(with_normals.plane->normal.z(), 0.99);
  EXPECT_EQ(with_normals.objects.size(), 1u);
  const ObjectSegmentation seen = segment_objects(points, kNoNormals, {}, std::nullopt, {0, 0, 1});
  ASSERT_TRUE(seen.plane.has_value());
  EXPECT_NEAR(seen.plane->normal.dot(middle), seen.plane->offset, 0.007);
  EXPECT_GT(seen.plane->normal.z(), 0.99);
  EXPECT_TRUE(seen.warning.empty());
  const ObjectSegmentation below =
      segment_objects(points, kNoNormals, {}, SupportingPlane{Vector3d::UnitZ(), 0}, {0, 0, -1});
  EXPECT_NE(below.warning.find("eye"), std::string::npos);
}

TEST(SegmentObjects, ALeafBelowThePointsSpacingIsTold) {
  ObjectSegmentationOptions options;
  options.leaf = 0.0005;
  options.patch = 0.01;
  const std::vector<Body> bodies{box({0.10, 0.07, 0.08}, 0, 0)};
  EXPECT_NE(segment_depth_image(seen(bodies), options).warning.find("leaf"), std::string::npos);
}

TEST(SegmentObjects, MisuseIsRefused) {
  const Matrix3Xd points = columns(table(0.05));
  const auto refuses = [&](const std::function<void(ObjectSegmentationOptions&)>& change) {
    ObjectSegmentationOptions options;
    change(options);
    EXPECT_THROW(segment_objects(points, kNoNormals, options), InvalidInput);
  };
  refuses([](auto& o) { o.leaf = 0; });
  refuses([](auto& o) { o.leaf = NAN; });
  refuses([](auto& o) { o.plane_tolerance = -1; });
  refuses([](auto& o) { o.up = Vector3d(NAN, 0, 0); });
  refuses([](auto& o) { o.up_angle = 2; });
  refuses([](auto& o) { o.min_plane_share = 1.1; });
  refuses([](auto& o) { o.max_height = o.plane_tolerance; });
  refuses([](auto& o) { o.max_beside = -0.1; });
  refuses([](auto& o) { o.patch = 1.5 * o.leaf; });
  refuses([](auto& o) { o.concavity = 0; });
  refuses([](auto& o) { o.min_points = 0; });
  refuses([](auto& o) { o.plane_iterations = 0; });
  EXPECT_THROW(segment_objects(points, Matrix3Xd::Zero(3, 2)), InvalidInput);
  EXPECT_THROW(segment_objects(points, Matrix3Xd::Constant(3, points.cols(), NAN)), InvalidInput);
  EXPECT_THROW(segment_objects(Matrix3Xd::Constant(3, 20, 1e7)), InvalidInput);
  EXPECT_THROW(segment_objects(points, kNoNormals, {}, SupportingPlane{Vector3d(0, 0, 2), 0}), InvalidInput);
  EXPECT_THROW(segment_objects(points, kNoNormals, {}, SupportingPlane{Vector3d::UnitZ(), NAN}), InvalidInput);
  EXPECT_THROW(segment_objects(points, kNoNormals, {}, std::nullopt, Vector3d::Constant(NAN)), InvalidInput);
  EXPECT_THROW(segment_depth_image(DepthImage{}), InvalidInput);
}

/// PCL writes hundreds of lines when no three points span a plane; here that is an answer. From several threads at
/// once, too, since PCL has one level for all of them.
TEST(SegmentObjects, PointsOnALineWriteNothing) {
  std::vector<Vector3d> line;
  for (int k = 0; k < 60; ++k) line.emplace_back(0.005 * k, 0, 0);
  const Matrix3Xd points = columns(line);
  testing::internal::CaptureStderr();
  std::vector<std::thread> threads;
  for (int k = 0; k < 4; ++k) {
    threads.emplace_back([&] {
      for (int again = 0; again < 5; ++again) EXPECT_FALSE(segment_objects(points).plane.has_value());
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}
