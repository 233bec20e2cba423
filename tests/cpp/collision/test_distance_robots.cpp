// Distances of whole robots with their meshes: the gradient against central differences, and the list of near pairs
// against the smallest one.

#include <gtest/gtest.h>

#include "mmgrasp/collision/checker.hpp"
#include "mmgrasp/core/random.hpp"
#include "support/mesh_robots.hpp"

using namespace mmgrasp;
using namespace mmgrasp::testing_support;

namespace {

World boxes(const MeshArm& arm, unsigned seed, int count, bool attached) {
  Rng rng(seed);
  World world;
  for (int i = 0; i < count; ++i) {
    const double angle = rng.uniform(-M_PI, M_PI), r = rng.uniform(0.45, arm.reach);
    Pose T = Pose::Identity();
    T.translation() << r * std::cos(angle), r * std::sin(angle), rng.uniform(arm.low, arm.high);
    T.linear() = rng.rotation().toRotationMatrix();
    world.add("box" + std::to_string(i), Box{{rng.uniform(0.04, 0.2), 0.1, rng.uniform(0.04, 0.2)}}, T);
  }
  if (attached) {
    Pose T = Pose::Identity();
    T.translation().z() = 0.25;
    world.add("part", Cylinder{0.03, 0.2}, Pose::Identity());
    world.attach("part", arm.group.robot().links()[arm.group.tip_link()].name, T);
  }
  return world;
}

struct Tally {
  int scene = 0, self = 0, attached = 0, overlapping = 0, kinks = 0;
};

// Steps that straddle a change of the closest points have no derivative: one-sided differences tell them.
void expect_gradients(const MeshArm& arm, CheckerOptions options, int samples, Tally& tally) {
  const double h = 1e-6;
  CollisionChecker checker(arm.group, boxes(arm, 3, 10, true), options);
  Rng rng(4);
  Eigen::VectorXd lower = arm.group.sample_lower(), upper = arm.group.sample_upper();
  if (arm.group.has_base()) {
    lower.head<2>().setConstant(-0.3);
    upper.head<2>().setConstant(0.3);
  }
  for (int n = 0; n < samples; ++n) {
    const Eigen::VectorXd q = rng.uniform(lower, upper);
    const DistanceResult here = checker.distance_and_gradient(q);
    ASSERT_EQ(here.gradient.size(), q.size());
    ASSERT_EQ(here.value, checker.distance(q).value);
    bool kink = false;
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      Eigen::VectorXd forward = q, back = q;
      forward[i] += h;
      back[i] -= h;
      const double plus = checker.distance(forward).value, minus = checker.distance(back).value;
      const double rise = (plus - here.value) / h, fall = (here.value - minus) / h;
      if (std::abs(rise - fall) > 1e-3) {
        kink = true;
        continue;
      }
      ASSERT_NEAR(here.gradient[i], 0.5 * (rise + fall), 2e-3)
          << arm.name << ", joint " << i << ", " << here.a << " and " << here.b << ", distance " << here.value;
    }
    tally.kinks += kink;
    if (kink) continue;
    ++(here.with_scene ? tally.scene : tally.self);
    tally.attached += here.a == "part" || here.b == "part";
    tally.overlapping += here.value < 0;
  }
}

Tally tally_of(const MeshArm& arm) {
  Tally tally;
  for (const bool self : {false, true}) {
    CheckerOptions options;
    options.check_self = self;
    options.check_scene = !self;
    expect_gradients(arm, options, 60, tally);
  }
  std::printf("%s: gradients of %d scene pairs, %d self pairs, %d of an attached part, %d in overlap; %d kinks\n",
              arm.name.c_str(), tally.scene, tally.self, tally.attached, tally.overlapping, tally.kinks);
  EXPECT_GT(tally.scene, 30);
  EXPECT_GT(tally.self, 30);
  EXPECT_LT(tally.kinks, 40);
  return tally;
}

}  // namespace

TEST(DistanceRobots, GradientIsTheDifference) {
  MMGRASP_NEEDS_SHARED_DATA();
  int attached = 0, overlapping = 0;
  for (const MeshArm& arm : {panda_arm(), ur5_arm(), tiago_arm(BaseKind::diff_drive)}) {
    const Tally tally = tally_of(arm);
    attached += tally.attached;
    overlapping += tally.overlapping;
    if (::testing::Test::HasFatalFailure()) return;
  }
  EXPECT_GT(attached, 10);
  EXPECT_GT(overlapping, 10);
}

TEST(DistanceRobots, NearPairsHoldTheNearest) {
  MMGRASP_NEEDS_SHARED_DATA();
  const MeshArm arm = panda_arm();
  const World world = boxes(arm, 5, 12, true);
  CollisionChecker checker(arm.group, world);
  Rng rng(6);
  int listed = 0;
  for (int n = 0; n < 60; ++n) {
    const Eigen::VectorXd q = rng.uniform(arm.group.lower(), arm.group.upper());
    const std::vector<DistanceResult> near = checker.distances(q, 0.15);
    const DistanceResult least = checker.distance_and_gradient(q);
    if (least.value < 0.15) {
      ASSERT_FALSE(near.empty());
      ASSERT_NEAR(near[0].value, least.value, 1e-9);
      ASSERT_EQ(near[0].a + near[0].b, least.a + least.b);
      ASSERT_LT((near[0].gradient - least.gradient).norm(), 1e-6);
    }
    for (std::size_t i = 1; i < near.size(); ++i) {
      ASSERT_GE(near[i].value, near[i - 1].value);
      ASSERT_LT(near[i].value, 0.15);
    }
    // Each pair of bodies on its own: only the two of them in a world of one object.
    for (const DistanceResult& pair : near) {
      if (!pair.with_scene) continue;
      World alone;
      alone.add(pair.b, world.objects().at(pair.b));
      if (pair.a == "part") continue;
      CheckerOptions scene_only;
      scene_only.check_self = false;
      CollisionChecker single(arm.group, alone, scene_only);
      ASSERT_LE(single.distance(q).value, pair.value + 1e-9);
      bool found = false;
      for (const DistanceResult& other : single.distances(q, 0.15))
        found = found || (other.a == pair.a && std::abs(other.value - pair.value) < 1e-9);
      ASSERT_TRUE(found) << pair.a << " and " << pair.b;
    }
    listed += static_cast<int>(near.size());
    // What touches is what is not apart.
    std::size_t touching = 0;
    for (const DistanceResult& pair : near) touching += pair.value <= 0;
    ASSERT_EQ(touching, checker.contacts(q).size());
  }
  EXPECT_GT(listed, 300);
}

TEST(DistanceRobots, WhatCannotMoveHasNoGradient) {
  MMGRASP_NEEDS_SHARED_DATA();
  const MeshArm arm = panda_arm();
  World world;
  Pose T = Pose::Identity();
  T.translation() << -0.16, 0, 0.02;
  world.add("post", Box{{0.02, 0.02, 0.02}}, T);
  CheckerOptions options;
  options.check_self = false;
  CollisionChecker checker(arm.group, world, options);
  Eigen::VectorXd q(7);
  q << 0, -0.785, 0, -2.356, 0, 1.571, 0.785;
  const DistanceResult result = checker.distance_and_gradient(q);
  EXPECT_EQ(result.a, "panda_link0");
  EXPECT_EQ(result.b, "post");
  EXPECT_EQ(result.gradient, Eigen::VectorXd::Zero(7));
  // The root moves: the distance follows.
  checker.set_root(pose_from_planar({1, 0, 0}));
  EXPECT_GT(checker.distance(q).value, result.value + 0.5);
}
