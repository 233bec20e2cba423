#include "mmgrasp/grasp/graspability.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <filesystem>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/geometry/point_cloud.hpp"
#include "mmgrasp/mapping/fit_cuboids.hpp"
#include "support/tray_scene.hpp"

using namespace mmgrasp;
using namespace tray_scene;

namespace {

constexpr double kPi = 3.14159265358979323846;
const PlacedShape kFloor{Plane{Vector3d::UnitZ(), 0.0}, Pose::Identity()};

double line_angle(double a, double b) {
  return std::abs(std::remainder(a - b, kPi));
}

PlacedShape box(const Vector3d& size, double x, double y, double yaw) {
  return {Box{size}, flat(x, y, size.z() / 2, yaw)};
}

const HeightMapProvenance& place_of(const Grasp& grasp) {
  return std::get<HeightMapProvenance>(grasp.provenance);
}

}  // namespace

TEST(Graspability, BoxIsTakenAcrossItsNarrowSideAtItsMiddle) {
  Rng rng(2);
  for (int i = 0; i < 4; ++i) {
    const double x = rng.uniform(-0.08, 0.08), y = rng.uniform(-0.05, 0.05), yaw = rng.uniform(-kPi, kPi);
    const HeightMap map = map_of({kFloor, box({0.16, 0.04, 0.05}, x, y, yaw)}, {0.4, 0.4});
    GraspabilityOptions options;
    options.orientations = 36;
    const Graspability found = evaluate_graspability(map, gripper(), options);
    ASSERT_FALSE(found.grasps.empty());
    const Grasp& best = found.grasps[0];
    EXPECT_LT(line_angle(place_of(best).angle, yaw + kPi / 2), kPi / 36 + 1e-6);
    EXPECT_NEAR(best.opening, 0.04, 0.004);
    const Vector3d p = flat(x, y, 0, yaw).inverse() * best.T_object_hand.translation();
    EXPECT_NEAR(p.y(), 0, 0.003);
    EXPECT_NEAR(p.x(), 0, 0.015);
    // The tool frame's axes: approach down, closing across the box.
    EXPECT_LT((best.T_object_hand.linear().col(0) + Vector3d::UnitZ()).norm(), 1e-12);
    EXPECT_NEAR(best.T_object_hand.linear().col(1).x(), std::cos(place_of(best).angle), 1e-12);
    EXPECT_NEAR(best.T_object_hand.translation().z(), place_of(best).height + 0.02, 1e-12);
    // The box is longer than the gripper opens: none of the grasps is along it.
    for (const Grasp& grasp : found.grasps) EXPECT_LT(line_angle(place_of(grasp).angle, yaw + kPi / 2), 1.0);
  }
}

TEST(Graspability, TooWideABoxGivesNone) {
  for (const double yaw : {0.0, 0.3, 0.8}) {
    const HeightMap map = map_of({kFloor, box({0.13, 0.11, 0.05}, 0.02, 0.01, yaw)}, {0.4, 0.4});
    EXPECT_TRUE(evaluate_graspability(map, gripper()).grasps.empty());
  }
}

TEST(Graspability, NeighbourNearerThanAFingerBlocksThatSide) {
  // Fingers take 12 mm and margins; a neighbour of the same height along the long sides leaves room or not.
  const auto grasps_across = [](double gap) {
    const HeightMap map = map_of({kFloor, box({0.12, 0.04, 0.05}, 0, 0, 0), box({0.12, 0.04, 0.05}, 0, 0.04 + gap, 0),
                                  box({0.12, 0.04, 0.05}, 0, -0.04 - gap, 0)},
                                 {0.4, 0.4});
    int across = 0;
    for (const Grasp& g : evaluate_graspability(map, gripper()).grasps)
      across += std::abs(g.T_object_hand.translation().y()) < 0.02 && line_angle(place_of(g).angle, kPi / 2) < 0.3;
    return across;
  };
  EXPECT_GT(grasps_across(0.05), 0);
  EXPECT_EQ(grasps_across(0.012), 0);
}

TEST(Graspability, TrayWallsCollide) {
  // Against a wall there is room for a finger on one side only.
  const auto tray = tray_shapes({0.3, 0.4, 0.1}, 0.005);
  for (const bool at_wall : {false, true}) {
    std::vector<PlacedShape> scene;
    add(scene, tray, Pose::Identity());
    scene.push_back(box({0.04, 0.12, 0.05}, at_wall ? 0.124 : 0.0, 0, 0));
    int across = 0;
    for (const Grasp& g : evaluate_graspability(map_of(scene, {0.4, 0.5}), gripper()).grasps)
      across += line_angle(place_of(g).angle, 0) < 0.3;
    EXPECT_EQ(across > 0, !at_wall);
  }
}

TEST(Graspability, QuarterTurnOfTheMapTurnsTheAnswer) {
  const HeightMap map =
      map_of({kFloor, box({0.1, 0.04, 0.05}, 0.03, 0.02, 0.5), box({0.05, 0.03, 0.04}, -0.08, 0.05, 1.2)}, {0.4, 0.3});
  HeightMap turned = map;
  turned.nx = map.ny;
  turned.ny = map.nx;
  for (int iy = 0; iy < map.ny; ++iy) {
    for (int ix = 0; ix < map.nx; ++ix) {
      const std::size_t to = turned.index(map.ny - 1 - iy, ix);
      turned.height[to] = map.height[map.index(ix, iy)];
      turned.upper[to] = map.upper[map.index(ix, iy)];
    }
  }
  GraspabilityOptions options;
  for (const double tip : {0.003, 0.02}) {
    const auto a = graspability_map(map, gripper(), kPi / 8, 0.1, tip, options);
    const auto b = graspability_map(turned, gripper(), kPi / 8 + kPi / 2, 0.1, tip, options);
    double largest = 0;
    for (int iy = 0; iy < map.ny; ++iy) {
      for (int ix = 0; ix < map.nx; ++ix) {
        largest = std::max<double>(largest, a[map.index(ix, iy)]);
        ASSERT_NEAR(a[map.index(ix, iy)], b[turned.index(map.ny - 1 - iy, ix)], 1e-6);
      }
    }
    EXPECT_GT(largest, 0.1);
  }
}

TEST(Graspability, ShiftOfTheMapShiftsTheAnswer) {
  const HeightMap map = map_of({kFloor, box({0.1, 0.04, 0.05}, 0.0, 0.0, 0.5)}, {0.5, 0.4});
  HeightMap shifted = map;
  const int sx = 20, sy = -11;
  for (int iy = 0; iy < map.ny; ++iy) {
    for (int ix = 0; ix < map.nx; ++ix) {
      const int jx = std::clamp(ix - sx, 0, map.nx - 1), jy = std::clamp(iy - sy, 0, map.ny - 1);
      shifted.height[map.index(ix, iy)] = map.height[map.index(jx, jy)];
      shifted.upper[map.index(ix, iy)] = map.upper[map.index(jx, jy)];
    }
  }
  const auto a = evaluate_graspability(map, gripper()).grasps, b = evaluate_graspability(shifted, gripper()).grasps;
  ASSERT_FALSE(a.empty());
  ASSERT_EQ(a.size(), b.size());
  const Vector3d shift(sx * map.resolution, sy * map.resolution, 0);
  EXPECT_LT((b[0].T_object_hand.translation() - a[0].T_object_hand.translation() - shift).norm(), 1e-9);
  EXPECT_NEAR(a[0].quality, b[0].quality, 1e-6);
}

TEST(Graspability, MapIsContactWhereNothingIsTouched) {
  // Brute force with the masks themselves, without smoothing.
  const HeightMap map = map_of(
      {kFloor, box({0.06, 0.03, 0.05}, 0.01, 0.0, 0.4), box({0.05, 0.05, 0.02}, -0.05, 0.03, 0)}, {0.24, 0.2}, 0.004);
  GraspabilityOptions options;
  options.smoothing = 0;
  const double angle = 1.9, opening = 0.07, tip = 0.012;
  const auto found = graspability_map(map, gripper(), angle, opening, tip, options);
  const HandMasks masks = make_hand_masks(gripper(), opening, angle, map.resolution);
  int graspable = 0;
  for (int y = 0; y < map.ny; ++y) {
    for (int x = 0; x < map.nx; ++x) {
      int contact = 0;
      bool touched = false;
      for (int dy = -30; dy <= 30; ++dy) {
        for (int dx = -30; dx <= 30; ++dx) {
          const auto in = [&](const MaskImage& m) {
            return std::abs(dx) <= m.radius && std::abs(dy) <= m.radius && m.at(dx, dy);
          };
          const int u = x + dx, v = y + dy;
          const bool inside = u >= 0 && v >= 0 && u < map.nx && v < map.ny;
          const float h = inside ? map.height[map.index(u, v)] : NAN, upper = inside ? map.upper[map.index(u, v)] : NAN;
          contact += in(masks.contact) && h > static_cast<float>(tip + options.insertion);
          touched = touched || (in(masks.fingers) && !(upper <= static_cast<float>(tip - options.margin)));
        }
      }
      const float expected = touched ? 0 : static_cast<float>(contact) / masks.contact.count();
      ASSERT_NEAR(found[map.index(x, y)], expected, 1e-6);
      graspable += expected > 0;
    }
  }
  EXPECT_GT(graspable, 20);
}

TEST(Graspability, SameAnswerAtAnyThreadCount) {
  const HeightMap map = map_of({kFloor, box({0.1, 0.04, 0.05}, 0.03, 0.02, 0.5)}, {0.4, 0.3});
  GraspabilityOptions options;
  options.threads = 1;
  const auto a = evaluate_graspability(map, gripper(), options).grasps;
  options.threads = 3;
  const auto b = evaluate_graspability(map, gripper(), options).grasps;
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].T_object_hand.matrix(), b[i].T_object_hand.matrix());
}

/// Random trays: the open hand at every grasp beside the true bodies, not beside what the camera saw of them.
TEST(Graspability, HandsAreFreeInRandomTrays) {
  const std::vector<std::vector<LinkShape>> kinds{
      {at(Box{{0.06, 0.04, 0.03}})},
      {at(Cylinder{0.015, 0.07})},
      {at(Box{{0.08, 0.02, 0.02}}), at(Box{{0.02, 0.05, 0.02}}, flat(0.03, 0.035, 0))}};
  const Vector3d size(0.3, 0.4, 0.1);
  int grasps = 0, free = 0;
  for (std::size_t kind = 0; kind < kinds.size(); ++kind) {
    for (unsigned seed = 1; seed <= 4; ++seed) {
      PlacementOptions placement;
      placement.count = 8;
      placement.seed = seed;
      std::vector<PlacedShape> scene;
      add(scene, tray_shapes(size, 0.005), Pose::Identity());
      for (const PlacedPart& part : random_placement(kinds[kind], size, 0.005, placement).parts)
        add(scene, kinds[kind], part.T_tray_part);
      RenderOptions render;
      render.noise = seed % 2 ? 0.0 : 0.001;
      render.seed = seed;
      DepthImage image;
      const HeightMap map = map_of(scene, {0.44, 0.54}, 0.002, render, &image);
      auto found = evaluate_graspability(map, gripper());
      EXPECT_GT(found.grasps.size(), 2u) << kind << " " << seed;
      find_pixels(image, found.grasps);
      const World world = world_of(scene);
      for (const Grasp& grasp : found.grasps) {
        ++grasps;
        free += hand_is_free(grasp, gripper(), world);
        // Something stands between the pads: the pixel sees it above the fingertips.
        EXPECT_GE(place_of(grasp).pixel.x(), 0);
      }
    }
  }
  EXPECT_GT(grasps, 100);
  EXPECT_EQ(free, grasps);
}

namespace {

/// The pinhole camera of an organised cloud: pixels are linear in x / z and y / z.
PinholeCamera camera_of(const PointCloud& cloud) {
  PinholeCamera camera;
  for (int k = 0; k < 2; ++k) {
    Eigen::Matrix2d A = Eigen::Matrix2d::Zero();
    Eigen::Vector2d b = Eigen::Vector2d::Zero();
    for (int v = 0; v < cloud.height; ++v) {
      for (int u = 0; u < cloud.width; ++u) {
        const Vector3d& p = cloud.points[static_cast<std::size_t>(v) * cloud.width + u];
        if (!p.allFinite()) continue;
        const Eigen::Vector2d row(p[k] / p.z(), 1);
        A += row * row.transpose();
        b += row * (k == 0 ? u : v);
      }
    }
    const Eigen::Vector2d line = A.inverse() * b;
    (k == 0 ? camera.fx : camera.fy) = line[0];
    (k == 0 ? camera.cx : camera.cy) = line[1];
  }
  return camera;
}

/// A real organised cloud as an image, and a map on its dominant plane around what stands there.
struct RealScene {
  explicit RealScene(const std::string& path) : cloud(read_pcd(path)) {
    DepthImage image{camera_of(cloud), Pose::Identity(), {}};
    for (const Vector3d& p : cloud.points) image.depth.push_back(p.allFinite() ? static_cast<float>(p.z()) : 0.0f);
    CuboidFitOptions options;
    options.up.setZero();
    options.plane_tolerance = 0.012;
    options.leaf = 0.006;
    options.cluster_tolerance = 0.02;
    options.min_points = 300;
    const CuboidFit fit = fit_cuboids(cloud.points, options);
    cuboids = fit.cuboids;
    Vector3d middle = Vector3d::Zero();
    for (const FittedCuboid& c : cuboids) middle += c.T_world_box.translation() / cuboids.size();
    const Vector3d up = fit.plane_normal, x = (Vector3d::UnitX() - up.x() * up).normalized();
    Pose T = Pose::Identity();
    T.linear() << x, up.cross(x), up;
    T.translation() = middle - (up.dot(middle) - fit.plane_offset) * up;
    map = make_height_map(image, T, {0.6, 0.6});
  }
  PointCloud cloud;
  std::vector<FittedCuboid> cuboids;
  HeightMap map;
};

}  // namespace

/// A mug on a table: no measured point lies inside fingers or palm, and some lie between the fingers.
TEST(Graspability, RealCloudKeepsTheHandClear) {
  const std::string path = std::string(MMGRASP_SHARED_DATA) + "/clouds/pcl/table_scene_mug_stereo_textured.pcd";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no reference data";
  const RealScene scene(path);
  ASSERT_EQ(scene.cuboids.size(), 1u);  // the mug
  EXPECT_LT((scene.cuboids[0].size - Vector3d(0.085, 0.085, 0.095)).cwiseAbs().maxCoeff(), 0.015);
  GraspabilityOptions options;
  options.lowest = 0.03;
  options.orientations = 24;
  const auto found = evaluate_graspability(scene.map, gripper(), options);
  EXPECT_GE(found.grasps.size(), 1u);
  for (const Grasp& grasp : found.grasps) {
    const Pose T_hand_world = grasp.T_object_hand.inverse();
    const double opened = gripper().pregrasp_opening(grasp.opening);
    int between = 0, inside = 0;
    for (const Vector3d& p : scene.cloud.points) {
      if (!p.allFinite()) continue;
      const Vector3d q = T_hand_world * p;  // approach x, closing y
      const double side = std::abs(q.y());
      if (q.x() < 0.02 && q.x() > 0.02 - gripper().body.finger_length && std::abs(q.z()) < 0.011) {
        between += side < opened / 2;
        inside += side > opened / 2 && side < opened / 2 + gripper().body.finger_thickness;
      }
      inside +=
          q.x() <= 0.02 - gripper().body.finger_length && q.x() > -0.15 && side < 0.065 && std::abs(q.z()) < 0.0325;
    }
    EXPECT_EQ(inside, 0);
    EXPECT_GT(between, 20);
    // At the mug or its handle.
    const Vector3d from_mug = scene.cuboids[0].T_world_box.inverse() * grasp.T_object_hand.translation();
    EXPECT_LT(from_mug.head<2>().norm(), 0.1);
    EXPECT_LT(std::abs(from_mug.z()), 0.1);
  }
}

/// Two packages, both wider than the gripper opens by their labels' own extent: no grasp is claimed.
TEST(Graspability, RealPackagesTooWideGiveNone) {
  const std::string path = std::string(MMGRASP_SHARED_DATA) + "/clouds/pcl/mOSD/learn0.pcd";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no reference data";
  const RealScene scene(path);
  ASSERT_EQ(scene.cuboids.size(), 2u);
  for (const FittedCuboid& c : scene.cuboids) EXPECT_GT(c.size.x(), 0.12);
  const auto found = evaluate_graspability(scene.map, gripper());
  EXPECT_TRUE(found.grasps.empty());
  EXPECT_GT(found.counts.tried, 0u);
}

TEST(Graspability, MisuseIsRefused) {
  HeightMap map = map_of({kFloor}, {0.1, 0.1});
  GraspabilityOptions options;
  options.orientations = 0;
  EXPECT_THROW(evaluate_graspability(map, gripper(), options), InvalidInput);
  map.upper.pop_back();
  EXPECT_THROW(evaluate_graspability(map, gripper()), InvalidInput);
}
