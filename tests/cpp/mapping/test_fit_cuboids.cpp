#include "mmgrasp/mapping/fit_cuboids.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <map>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/geometry/point_cloud.hpp"
#include "mmgrasp/mapping/depth_image.hpp"

using namespace mmgrasp;
using Eigen::Vector3d;

namespace {

constexpr double kPi = 3.14159265358979323846;
const std::filesystem::path kClouds = std::filesystem::path(std::string(MMGRASP_SHARED_DATA)) / "clouds";

struct TrueBox {
  Vector3d size;
  double x, y, yaw;
  Pose pose() const {
    Pose T = Pose(Eigen::AngleAxisd(yaw, Vector3d::UnitZ()));
    T.translation() << x, y, size.z() / 2;
    return T;
  }
};

const std::vector<TrueBox> kBoxes{{{0.06, 0.04, 0.05}, -0.08, 0.1, 0.3},
                                  {{0.08, 0.03, 0.03}, 0.05, 0.12, -0.9},
                                  {{0.05, 0.05, 0.06}, 0.07, -0.02, 0.5},
                                  {{0.09, 0.05, 0.04}, -0.07, -0.1, 1.4}};

/// A camera above the scene, leaning by `tilt` about x.
Pose camera_at(double tilt, double distance) {
  Pose T = Pose(Eigen::AngleAxisd(tilt, Vector3d::UnitX())) * look_down({0, 0, distance});
  return T;
}

DepthImage scan(const Pose& T_world_camera, double noise, bool tray, unsigned seed) {
  std::vector<PlacedShape> scene{{Plane{Vector3d::UnitZ(), tray ? -0.005 : 0.0}, Pose::Identity()}};
  for (const TrueBox& box : kBoxes) scene.push_back({Box{box.size}, box.pose()});
  if (tray) {
    scene.push_back({Box{{0.3, 0.4, 0.005}}, Pose(Eigen::Translation3d(0, 0, -0.0025))});
    for (const double side : {-1.0, 1.0}) {
      scene.push_back({Box{{0.005, 0.4, 0.1}}, Pose(Eigen::Translation3d(side * 0.1475, 0, 0.045))});
      scene.push_back({Box{{0.3, 0.005, 0.1}}, Pose(Eigen::Translation3d(0, side * 0.1975, 0.045))});
    }
  }
  RenderOptions options;
  options.noise = noise;
  options.missing = 0.02;
  options.seed = seed;
  return render_depth(scene, PinholeCamera(), T_world_camera, options);
}

void expect_boxes(const CuboidFit& fit, double metres, double radians) {
  ASSERT_EQ(fit.cuboids.size(), kBoxes.size());
  for (const TrueBox& box : kBoxes) {
    const Pose T = box.pose();
    const FittedCuboid* best = nullptr;
    for (const FittedCuboid& c : fit.cuboids) {
      if (!best || (c.T_world_box.translation() - T.translation()).norm() <
                       (best->T_world_box.translation() - T.translation()).norm())
        best = &c;
    }
    EXPECT_LT((best->T_world_box.translation() - T.translation()).norm(), metres);
    EXPECT_LT((best->size - box.size).cwiseAbs().maxCoeff(), metres);
    const Vector3d x = best->T_world_box.linear().col(0);
    const double period = std::abs(box.size.x() - box.size.y()) < 1e-9 ? kPi / 2 : kPi;
    EXPECT_LT(std::abs(std::remainder(std::atan2(x.y(), x.x()) - box.yaw, period)), radians);
    EXPECT_GT(best->T_world_box.linear()(2, 2), 1 - 1e-3);
    EXPECT_GT(best->fill, 0.85);
  }
}

}  // namespace

TEST(FitCuboids, BoxesOnATableSeenFromAbove) {
  const Pose camera = camera_at(0, 0.7);
  const CuboidFit fit = fit_cuboids(scan(camera, 0, false, 1).points(), {}, std::nullopt, camera.translation());
  ASSERT_TRUE(fit.plane_found);
  EXPECT_NEAR(fit.plane_offset, 0, 1e-4);
  EXPECT_GT(fit.plane_normal.z(), 1 - 1e-6);
  expect_boxes(fit, 0.0012, 0.02);
}

TEST(FitCuboids, BoxesOnATableWithNoise) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const Pose camera = camera_at(0.35, 0.7);
    const CuboidFit fit =
        fit_cuboids(scan(camera, 0.002, false, seed).points(), {}, std::nullopt, camera.translation());
    expect_boxes(fit, 0.003, 0.06);
  }
}

TEST(FitCuboids, BoxesInATrayWithNoise) {
  KnownTray tray;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const Pose camera = camera_at(0.15, 0.8);
    const auto points = scan(camera, 0.002, true, seed).points();
    const CuboidFit fit = fit_cuboids(points, {}, tray, camera.translation());
    expect_boxes(fit, 0.003, 0.06);
    EXPECT_EQ(fit.labels.size(), points.size());
  }
}

TEST(FitCuboids, AnyRigidMotionMovesTheAnswer) {
  const Pose camera = camera_at(0.2, 0.7);
  auto points = scan(camera, 0.001, false, 2).points();
  CuboidFitOptions options;
  const CuboidFit before = fit_cuboids(points, options, std::nullopt, camera.translation());
  const Pose T = pose_from_xyz_rpy({0.4, -0.3, 0.8}, {0.7, -0.4, 2.0});
  for (Vector3d& p : points) p = T * p;
  options.up = T.linear().col(2);
  const CuboidFit after = fit_cuboids(points, options, std::nullopt, T * camera.translation());
  ASSERT_EQ(after.cuboids.size(), before.cuboids.size());
  for (std::size_t i = 0; i < before.cuboids.size(); ++i) {
    // The thinning grid does not turn along: sub-millimetre differences remain.
    EXPECT_LT((after.cuboids[i].T_world_box.translation() - T * before.cuboids[i].T_world_box.translation()).norm(),
              1e-3);
    EXPECT_LT((after.cuboids[i].size - before.cuboids[i].size).norm(), 1.5e-3);
  }
  options.up.setZero();  // the scanner stands above the table
  const CuboidFit unguided = fit_cuboids(points, options, std::nullopt, T * camera.translation());
  EXPECT_GT(unguided.plane_normal.dot(T.linear().col(2)), 1 - 1e-4);
  EXPECT_EQ(unguided.cuboids.size(), before.cuboids.size());
}

TEST(FitCuboids, NothingThereIsNoError) {
  EXPECT_FALSE(fit_cuboids({}).plane_found);
  const Vector3d nan = Vector3d::Constant(NAN);
  const CuboidFit fit = fit_cuboids({nan, {0, 0, 0}, nan});
  EXPECT_FALSE(fit.plane_found);
  EXPECT_EQ(fit.labels, (std::vector<int>{-2, -2, -2}));
  std::vector<Vector3d> table;
  for (int i = 0; i < 2500; ++i) table.emplace_back(0.01 * (i % 50), 0.01 * (i / 50), 0);
  EXPECT_TRUE(fit_cuboids(table).cuboids.empty());
  EXPECT_TRUE(fit_cuboids(table).plane_found);
}

TEST(FitCuboids, MisuseIsRefused) {
  CuboidFitOptions options;
  options.leaf = 0.02;
  EXPECT_THROW(fit_cuboids({}, options), InvalidInput);
  KnownTray tray;
  tray.wall = 0.2;
  EXPECT_THROW(fit_cuboids({}, {}, tray), InvalidInput);
}

/// A scene with labels given by people: every labelled object that stands on the table is found.
TEST(FitCuboids, LabelledTableScene) {
  if (!std::filesystem::exists(kClouds)) GTEST_SKIP() << "no reference data";
  const PointCloud cloud = read_pcd(kClouds / "pcl/mOSD/learn0.pcd");
  CuboidFitOptions options;
  options.up.setZero();
  options.plane_tolerance = 0.012;
  options.leaf = 0.006;
  options.cluster_tolerance = 0.02;
  options.min_points = 300;
  const CuboidFit fit = fit_cuboids(cloud.points, options);
  std::map<int, std::size_t> truth, found;
  std::map<std::pair<int, int>, std::size_t> both;
  std::size_t table = 0, table_found = 0;
  for (std::size_t i = 0; i < cloud.points.size(); ++i) {
    const int label = cloud.labels[i] / 10;  // parts of one object together
    if (cloud.labels[i] == 0) continue;
    if (label == 0) {
      ++table;
      table_found += fit.labels[i] < 0;
      continue;
    }
    ++truth[label];
    if (fit.labels[i] >= 0) ++both[{label, fit.labels[i]}];
  }
  for (const int label : fit.labels) {
    if (label >= 0) ++found[label];
  }
  EXPECT_GT(table_found, 0.98 * table);
  ASSERT_FALSE(truth.empty());
  EXPECT_EQ(fit.cuboids.size(), truth.size());
  for (const auto& [label, size] : truth) {
    double best = 0;
    for (const auto& [pair, common] : both) {
      if (pair.first == label)
        best = std::max(best, static_cast<double>(common) / (size + found[pair.second] - common));
    }
    EXPECT_GT(best, 0.8) << "object " << label << " of " << size << " points";
  }
}
