// Edges by conservative advancement: what steps jump over is found, and what is called free is free at every one of
// many samples.

#include <gtest/gtest.h>

#include "mmgrasp/collision/edge.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "support/free_body.hpp"
#include "support/mesh_robots.hpp"

using namespace mmgrasp;
using namespace mmgrasp::testing_support;

namespace {

EdgeOptions continuous(double tolerance = 1e-4) {
  EdgeOptions options;
  options.continuous = true;
  options.tolerance = tolerance;
  return options;
}

Pose at(double x, double y, double z) {
  Pose T = Pose::Identity();
  T.translation() << x, y, z;
  return T;
}

World scattered(const MeshArm& arm, unsigned seed, int count) {
  Rng rng(seed);
  World world;
  for (int i = 0; i < count; ++i) {
    const double angle = rng.uniform(-M_PI, M_PI), r = rng.uniform(0.45, arm.reach);
    Pose T = at(r * std::cos(angle), r * std::sin(angle), rng.uniform(arm.low, arm.high));
    T.linear() = rng.rotation().toRotationMatrix();
    const std::string name = "body" + std::to_string(i);
    i % 2 == 0 ? world.add(name, Box{{0.2, 0.15, 0.002}}, T) : world.add(name, Capsule{0.02, 0.2}, T);
  }
  return world;
}

}  // namespace

TEST(EdgeContinuous, ThinWallsAreNotJumpedOver) {
  // A needle on a lever of 2 m sweeps 40 mm a step of 0.02 rad; the wall is 1 mm thick.
  const JointGroup group = free_body::group({free_body::link_shape(Box{{0.002, 0.002, 0.002}})});
  const JointGroup lever = free_body::robot({})
                               .with_link("tip", "carrier", at(2, 0, 0), {free_body::link_shape(Sphere{0.001})})
                               .chain("root", "tip");
  World world;
  world.add("wall", Box{{0.3, 0.001, 0.3}}, at(2, 0.01, 0));
  CollisionChecker checker(lever, world);
  Eigen::VectorXd q0 = Eigen::VectorXd::Zero(6), q1 = q0;
  q0[3] = -0.1;
  q1[3] = 0.1;
  EXPECT_TRUE(checker.edge_is_free(q0, q1, 0.02)) << "steps of 0.02 rad land on either side";
  const EdgeResult result = check_edge(checker, q0, q1, continuous());
  EXPECT_FALSE(result.free);
  ASSERT_TRUE(result.contact);
  EXPECT_EQ(result.contact->a, "tip");
  EXPECT_EQ(result.contact->b, "wall");
  // The needle meets the wall's near face at y = 0.0095 - 0.001.
  EXPECT_NEAR(2 * std::sin(-0.1 + 0.2 * result.fraction), 0.0085, 2e-4);
  // Straight through along y, far faster than any step.
  World screen;
  screen.add("screen", Box{{1, 0.001, 1}}, at(0, 5, 0));
  CollisionChecker flying(group, screen);
  q0.setZero();
  q1 << 0.2, 9.9, 0.1, 0, 0, 0;
  const EdgeResult through = check_edge(flying, q0, q1, continuous());
  EXPECT_FALSE(through.free);
  EXPECT_NEAR(through.fraction, (5 - 0.0005 - 0.001) / 9.9, 1e-4);
  q1[1] = 4.99;
  EXPECT_TRUE(check_edge(flying, q0, q1, continuous()).free);
}

TEST(EdgeContinuous, FreeMeansFreeAtEverySample) {
  MMGRASP_NEEDS_SHARED_DATA();
  int jumped_over = 0;
  for (const MeshArm& arm : {panda_arm(), ur5_arm(), tiago_arm()}) {
    CollisionChecker checker(arm.group, scattered(arm, 3, 14));
    Rng rng(4);
    int free = 0, refused = 0, missed = 0, looks = 0;
    while (free + refused < 80) {
      const Eigen::VectorXd q0 = rng.uniform(arm.group.sample_lower(), arm.group.sample_upper());
      if (!checker.is_free(q0)) continue;
      const Eigen::VectorXd target = rng.uniform(arm.group.sample_lower(), arm.group.sample_upper());
      const Eigen::VectorXd q1 = q0 + (target - q0) * (0.7 / (target - q0).cwiseAbs().maxCoeff());
      if ((q1 - q0).norm() > (target - q0).norm()) continue;
      const EdgeResult result = check_edge(checker, q0, q1, continuous());
      looks += result.checks;
      // Up to where it stopped, dense samples are free; where it stopped, something is within the tolerance.
      for (int i = 0; i <= 200; ++i) {
        const double s = result.fraction * (i / 200.0) * (1 - 1e-9);
        ASSERT_TRUE(checker.is_free(q0 + (q1 - q0) * s)) << arm.name << " at " << s;
      }
      if (result.free) {
        ASSERT_EQ(result.fraction, 1);
        ++free;
        continue;
      }
      ++refused;
      ASSERT_TRUE(result.contact);
      const std::vector<DistanceResult> near = checker.distances(q0 + (q1 - q0) * result.fraction, 2e-4);
      ASSERT_FALSE(near.empty());
      ASSERT_LE(near[0].value, 1e-4);
      missed += checker.edge_is_free(q0, q1, 0.02);
    }
    std::printf("%s: %d free, %d refused of which steps of 0.02 missed %d; %.1f looks an edge\n", arm.name.c_str(),
                free, refused, missed, looks / 80.0);
    EXPECT_GT(free, 20);
    EXPECT_GT(refused, 10);
    jumped_over += missed;
  }
  EXPECT_GT(jumped_over, 0);
}

TEST(EdgeContinuous, PaddingLimitsAndStartsAreKept) {
  const JointGroup group = free_body::group({free_body::link_shape(Sphere{0.1})});
  World world;
  world.add("wall", Box{{0.1, 4, 4}}, at(1, 0, 0));
  Eigen::VectorXd q0 = Eigen::VectorXd::Zero(6), q1 = q0;
  q1[0] = 0.8;  // 0.05 m short of the wall
  CollisionChecker plain(group, world);
  EXPECT_TRUE(check_edge(plain, q0, q1, continuous()).free);
  EXPECT_FALSE(check_edge(plain, q0, q1, continuous(0.12)).free) << "gaps below half the tolerance are never passed";
  CheckerOptions padded;
  padded.padding = 0.06;
  CollisionChecker careful(group, world, padded);
  const EdgeResult stopped = check_edge(careful, q0, q1, continuous());
  EXPECT_FALSE(stopped.free);
  EXPECT_NEAR(0.8 * stopped.fraction, 0.95 - 0.1 - 0.06, 2e-4);
  // Limits end the edge without a contact.
  q1[0] = -20;
  const EdgeResult limited = check_edge(plain, q0, q1, continuous());
  EXPECT_FALSE(limited.free);
  EXPECT_FALSE(limited.contact);
  EXPECT_NEAR(limited.fraction, 0.5, 1e-6);
  // A start in the wall is refused there.
  q0[0] = 1;
  const EdgeResult started = check_edge(plain, q0, q1, continuous());
  EXPECT_FALSE(started.free);
  EXPECT_EQ(started.fraction, 0);
  ASSERT_TRUE(started.contact);
  EXPECT_EQ(started.contact->b, "wall");
  // Nothing moves.
  q0[0] = 0;
  EXPECT_TRUE(check_edge(plain, q0, q0, continuous()).free);
}

TEST(EdgeContinuous, AFloatingSphereMeetsAThinWall) {
  const Robot robot =
      Robot::from_strings(
          "<robot name='r'><link name='root'/><link name='arm'/><link name='carrier'/>"
          "<joint name='turn' type='revolute'><parent link='root'/><child link='arm'/><axis xyz='0 0 1'/>"
          "<limit lower='-2' upper='2' velocity='1' effort='1'/></joint>"
          "<joint name='fly' type='floating'><parent link='arm'/><child link='carrier'/></joint></robot>")
          .with_link("ball", "carrier", Pose::Identity(), {free_body::link_shape(Sphere{0.01})});
  const JointGroup group = robot.chain("root", "carrier");
  ASSERT_EQ(group.size(), 7);
  World world;
  world.add("wall", Box{{0.001, 1, 1}}, at(0.5, 0, 0));
  CollisionChecker checker(group, world);
  Eigen::VectorXd q0 = Eigen::VectorXd::Zero(7), q1 = q0;
  q1[1] = 0.9;
  const EdgeResult result = check_edge(checker, q0, q1, continuous());
  EXPECT_FALSE(result.free);
  EXPECT_NEAR(result.fraction * 0.9, 0.5 - 0.0005 - 0.01, 2e-4);
  EXPECT_FALSE(checker.edge_is_free(q0, q1, 0.005));
  q1[1] = 0.4;
  EXPECT_TRUE(check_edge(checker, q0, q1, continuous()).free);
  EXPECT_TRUE(checker.edge_is_free(q0, q1, 0.005));
}

TEST(EdgeContinuous, MotionsThatLeaveTheLineNeedTheRoomForIt) {
  // A ball of 1 cm passes a wall at 3 cm; what leaves the line by less than that stays clear of it.
  const JointGroup group = free_body::group({free_body::link_shape(Sphere{0.01})});
  World world;
  world.add("wall", Box{{1, 0.02, 1}}, at(0, 0.05, 0));
  CollisionChecker checker(group, world);
  Eigen::VectorXd q0 = Eigen::VectorXd::Zero(6), q1 = q0;
  q0[0] = -0.3;
  q1[0] = 0.3;
  EdgeOptions options = continuous();
  options.bend = Eigen::VectorXd::Zero(6);
  for (const double aside : {0.0, 0.02, 0.0298}) {
    options.bend[1] = aside;
    EXPECT_TRUE(check_edge(checker, q0, q1, options).free) << aside;
  }
  options.bend[1] = 0.03;
  EXPECT_FALSE(check_edge(checker, q0, q1, options).free);
  EXPECT_FALSE(check_edge(checker, q0, q0, options).free) << "out and back to the same place";
  options.bend[1] = 0.02;
  options.bend[2] = 0.02;  // together they could be 4 cm as far as the bound knows
  EXPECT_FALSE(check_edge(checker, q0, q1, options).free);
  options.bend = Eigen::VectorXd::Constant(6, -1);
  EXPECT_THROW(check_edge(checker, q0, q1, options), InvalidInput);
  options.bend = Eigen::VectorXd::Zero(2);
  EXPECT_THROW(check_edge(checker, q0, q1, options), InvalidInput);
}
