#include "mmgrasp/grasp/random_placement.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "support/tray_scene.hpp"

using namespace mmgrasp;
using namespace tray_scene;

TEST(RestingPoses, CubeLiesOnAnyFace) {
  const auto poses = resting_poses({at(Box{{0.1, 0.1, 0.1}}, flat(0.3, -0.2, 0.7))});
  ASSERT_EQ(poses.size(), 6u);
  for (const RestingPose& pose : poses) {
    EXPECT_NEAR(pose.probability, 1.0 / 6, 1e-9);
    EXPECT_LT((pose.T_floor_part * Vector3d(0.3, -0.2, 0.7) - Vector3d(0, 0, 0.05)).norm(), 1e-9);
  }
}

TEST(RestingPoses, SlabByTheSolidAnglesOfItsFaces) {
  // Solid angle of a rectangle 2a x 2b seen from height d above its middle: 4 atan(a b / (d sqrt(a^2 + b^2 + d^2))).
  const Vector3d half(0.05, 0.03, 0.01);
  const auto poses = resting_poses({at(Box{2 * half})});
  ASSERT_EQ(poses.size(), 6u);
  const double diagonal = half.norm();
  const auto share = [&](double a, double b, double d) { return 4 * std::atan(a * b / (d * diagonal)) / (4 * M_PI); };
  EXPECT_NEAR(poses[0].probability, share(half.x(), half.y(), half.z()), 1e-9);
  EXPECT_NEAR(poses[2].probability, share(half.x(), half.z(), half.y()), 1e-9);
  EXPECT_NEAR(poses[4].probability, share(half.y(), half.z(), half.x()), 1e-9);
}

TEST(RestingPoses, TallLeaningBodyTipsOver) {
  // A tower whose top hangs over: it does not stand on its small foot, for its centre of mass is beside it.
  const auto poses = resting_poses({at(Box{{0.02, 0.02, 0.02}}), at(Box{{0.1, 0.02, 0.02}}, flat(0.04, 0, 0.02))});
  double total = 0;
  for (const RestingPose& pose : poses) {
    total += pose.probability;
    EXPECT_GT((pose.T_floor_part.linear().row(2).transpose() - Vector3d::UnitZ()).norm(), 1e-3);
  }
  EXPECT_NEAR(total, 1, 1e-12);
  EXPECT_THROW(resting_poses({}), InvalidInput);
  EXPECT_THROW(resting_poses({at(Plane{})}), InvalidInput);
}

TEST(RandomPlacement, NothingTouchesAndNothingFloats) {
  const std::vector<LinkShape> part{at(Box{{0.08, 0.02, 0.02}}), at(Cylinder{0.012, 0.05}, flat(0.02, 0.03, 0))};
  const Vector3d size(0.3, 0.4, 0.1);
  for (unsigned seed = 1; seed <= 3; ++seed) {
    PlacementOptions options;
    options.count = 20;
    options.seed = seed;
    const RandomPlacement placed = random_placement(part, size, 0.005, options);
    EXPECT_EQ(placed.parts.size() + placed.not_placed, 20u);
    EXPECT_GE(placed.parts.size(), 15u);
    // One world with all of it: each part as the flying body against the others, and let down by 1.5 mm it touches.
    for (std::size_t i = 0; i < placed.parts.size(); ++i) {
      World world;
      world.add("tray", WorldObject{tray_shapes(size, 0.005), Pose::Identity()});
      for (std::size_t j = 0; j < i; ++j) world.add(std::to_string(j), WorldObject{part, placed.parts[j].T_tray_part});
      CollisionChecker checker(free_body::group(part), world);
      const Vector3d rpy = rpy_from_rotation(placed.parts[i].T_tray_part.linear());
      Eigen::VectorXd q(6);
      q << placed.parts[i].T_tray_part.translation(), rpy.z(), rpy.y(), rpy.x();
      EXPECT_TRUE(checker.is_free(q));
      q[2] -= 0.0015;
      EXPECT_FALSE(checker.is_free(q));
      double lowest = 1, x = 0, y = 0;
      for (const LinkShape& shape : part) {
        const auto box = shape_bounds(shape.shape, placed.parts[i].T_tray_part * shape.T_link_shape);
        lowest = std::min(lowest, box.min().z());
        x = std::max(x, box.max().cwiseAbs().x());
        y = std::max(y, box.max().cwiseAbs().y());
      }
      EXPECT_EQ(placed.parts[i].on_floor, lowest < 0.001);
      EXPECT_LT(x, 0.145);
      EXPECT_LT(y, 0.195);
    }
  }
}

TEST(RandomPlacement, SameSeedSamePlaces) {
  const std::vector<LinkShape> part{at(Box{{0.06, 0.04, 0.03}})};
  PlacementOptions options;
  options.count = 6;
  const auto a = random_placement(part, {0.3, 0.4, 0.1}, 0.005, options).parts;
  const auto b = random_placement(part, {0.3, 0.4, 0.1}, 0.005, options).parts;
  options.seed = 2;
  const auto c = random_placement(part, {0.3, 0.4, 0.1}, 0.005, options).parts;
  ASSERT_EQ(a.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(a[i].T_tray_part.matrix(), b[i].T_tray_part.matrix());
  EXPECT_NE(a[0].T_tray_part.matrix(), c[0].T_tray_part.matrix());
}

TEST(RandomPlacement, FullTraysSayWhatDidNotFit) {
  PlacementOptions options;
  options.count = 60;
  options.stack = false;
  options.draws = 30;
  const auto placed = random_placement({at(Box{{0.08, 0.08, 0.08}})}, {0.3, 0.3, 0.1}, 0.005, options);
  EXPECT_GT(placed.not_placed, 45);
  for (const PlacedPart& part : placed.parts) EXPECT_TRUE(part.on_floor);
  EXPECT_THROW(random_placement({at(Box{{0.5, 0.5, 0.5}})}, {0.3, 0.3, 0.1}, 0.005), InvalidInput);
}
