#include "mmgrasp/grasp/suction.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/grasp/sample_suction_grasps.hpp"
#include "mmgrasp/verify/plan_check.hpp"

namespace mmgrasp {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kGravity = 9.80665;
const Eigen::Vector3d kDown = Eigen::Vector3d::UnitZ();  // the cups face along the tool's z

LinkShape shape_at(const Shape& shape, const Pose& pose = Pose::Identity()) {
  LinkShape result;
  result.shape = shape;
  result.T_link_shape = pose;
  return result;
}

Suction one_cup(double radius, double max_gap = 0.0015) {
  Suction suction;
  suction.cups = {{Eigen::Vector3d::Zero(), radius}};
  suction.max_gap = max_gap;
  return suction;
}

Hand cup_hand(const Suction& suction) {
  return Hand::of_cups("cup", kDown, suction, {"cup"});
}

/// The tool over the origin at this height, its z down.
Pose above(double height, double x = 0) {
  return pose_from_xyz_rpy({x, 0, height}, {kPi, 0, 0});
}

verify::CheckedSuction checked(const Suction& suction) {
  verify::CheckedSuction result{{}, suction.max_gap, suction.vacuum, suction.friction, suction.safety};
  for (const SuctionCup& cup : suction.cups) result.cups.push_back({cup.position, cup.radius});
  return result;
}

std::string judged(const Suction& suction, const LinkShape& part, const Pose& T) {
  return verify::broken_seal(checked(suction), kDown, {part}, {T, 0});
}

double sagitta(double R, double r) {
  return R - std::sqrt(R * R - r * r);
}

TEST(SealGap, IsTheDistanceOfAPlane) {
  const LinkShape box = shape_at(Box{{0.1, 0.1, 0.1}});
  for (const double gap : {0.0, 0.0003, 0.015})
    EXPECT_NEAR(seal_gap({box}, above(0.05 + gap), kDown, one_cup(0.02)), gap, 1e-9);
  EXPECT_NEAR(seal_gap({box}, above(0.05 - 0.004), kDown, one_cup(0.02)), -0.004, 1e-9);
  EXPECT_TRUE(std::isinf(seal_gap({box}, above(0.05, 0.0301), kDown, one_cup(0.02))));  // the rim passes the edge
  EXPECT_NEAR(seal_gap({box}, above(0.05, 0.0299), kDown, one_cup(0.02)), 0, 1e-9);
}

TEST(SealGap, IsTheSagittaOfSpheresAndOfCylinders) {
  for (const double R : {0.03, 0.05, 0.2}) {
    for (const double r : {0.005, 0.01, 0.02}) {
      const double off = 1e-4, expected = sagitta(R, r) + off;
      EXPECT_NEAR(seal_gap({shape_at(Sphere{R})}, above(R + off), kDown, one_cup(r)), expected, 2e-4 * R);
      const LinkShape lying = shape_at(Cylinder{R, 0.3}, pose_from_xyz_rpy({0, 0, 0}, {kPi / 2, 0, 0}));
      EXPECT_NEAR(seal_gap({lying}, above(R + off), kDown, one_cup(r)), expected, 2e-4 * R);
    }
  }
}

// The judge moves needles through FCL's round bodies: the seal breaks where the closed form says.
TEST(BrokenSeal, BeginsAtTheSagitta) {
  const double R = 0.05, r = 0.015;
  const double fall = sagitta(R, r);
  const LinkShape ball = shape_at(Sphere{R});
  const LinkShape lying = shape_at(Cylinder{R, 0.3}, pose_from_xyz_rpy({0, 0, 0}, {kPi / 2, 0, 0}));
  const LinkShape box = shape_at(Box{{0.1, 0.1, 0.1}});
  const Suction suction = one_cup(r, fall + 2e-4);
  for (const LinkShape& part : {ball, lying}) {
    EXPECT_EQ(judged(suction, part, above(R + 1.8e-4)), "");
    EXPECT_NE(judged(suction, part, above(R + 2.3e-4)), "");
    EXPECT_NE(judged(suction, part, above(R - 2e-5)).find("reaches through"), std::string::npos);
  }
  EXPECT_EQ(judged(suction, box, above(0.05 + fall + 1.8e-4)), "");
  EXPECT_NE(judged(suction, box, above(0.05 + fall + 2.3e-4)), "");
  EXPECT_NE(judged(suction, box, above(0.05 + 1e-4, 0.0355)), "");
  EXPECT_EQ(judged(suction, box, above(0.05 + 1e-4, 0.0345)), "");
}

TEST(BrokenSeal, KnowsAHole) {
  // Four boxes around a hole of 1 cm, which a rim of 2 cm goes around.
  std::vector<LinkShape> plate;
  for (int k = 0; k < 4; ++k) {
    const Pose turn = pose_from_xyz_rpy({0, 0, 0}, {0, 0, k * kPi / 2});
    Pose T = turn;
    T.translate(Eigen::Vector3d(0.0325, 0.035, 0));  // from -5 mm, and from 5 mm on
    plate.push_back(shape_at(Box{{0.075, 0.06, 0.02}}, T));
  }
  const Suction wide = one_cup(0.02);
  EXPECT_TRUE(std::isinf(seal_gap(plate, above(0.0102), kDown, wide)));
  EXPECT_FALSE(verify::broken_seal(checked(wide), kDown, plate, {above(0.0102), 0}).empty());
  EXPECT_EQ(verify::broken_seal(checked(wide), kDown, plate, {above(0.0102, 0.035), 0}), "");
  EXPECT_NEAR(seal_gap(plate, above(0.0102, 0.035), kDown, wide), 2e-4, 1e-9);
}

TEST(SuctionShare, FollowsTheTextbook) {
  // The makers' load cases: straight down F = m g S, along a wall F = m g S / mu (Schmalz, "Vacuum knowledge").
  Suction suction = one_cup(0.02);
  const double force = suction.vacuum * kPi * 0.02 * 0.02;
  EXPECT_NEAR(suction.force(), force, 1e-9);
  const double mass = 1.3;
  const Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  const auto share = [&](const Eigen::Vector3d& pull) { return suction_share(suction, kDown, mass, centre, pull); };
  EXPECT_NEAR(share({0, 0, kGravity}), mass * kGravity * suction.safety / force, 1e-12);
  EXPECT_NEAR(share({0, 0, kGravity + 5}), mass * (kGravity + 5) * suction.safety / force, 1e-12);
  EXPECT_NEAR(share({kGravity, 0, 0}), mass * kGravity / suction.friction * suction.safety / force, 1e-12);
  EXPECT_EQ(share({0, 0, -kGravity}), 0);  // it lies on the cups
}

TEST(SuctionShare, TiltsAboutTheNearestEdge) {
  Suction suction = one_cup(0.02);
  suction.friction = 10;  // so that tilting decides
  const double force = suction.force(), h = 0.1;
  const double share = suction_share(suction, kDown, 1, {0, 0, h}, {kGravity, 0, 0});
  EXPECT_NEAR(share, kGravity * h / 0.02 * suction.safety / force, 1e-9);
  suction.cups = {{{0.05, 0, 0}, 0.02}, {{-0.05, 0, 0}, 0.02}};  // no wider across than one cup
  EXPECT_NEAR(suction_share(suction, kDown, 1, {0, 0, h}, {kGravity, 0, 0}), kGravity * h / 0.02 * 2 / suction.force(),
              1e-9);
}

TEST(SuctionShare, AnyWayIsTheMostOfAllDirections) {
  Rng rng(7);
  for (int trial = 0; trial < 40; ++trial) {
    Suction suction = one_cup(rng.uniform(0.005, 0.04));
    suction.friction = rng.uniform(0.2, 1);
    const Eigen::Vector3d centre(rng.uniform(-0.03, 0.03), rng.uniform(-0.03, 0.03), rng.uniform(0, 0.1));
    const double bound = suction_share_any_way(suction, kDown, 1, centre);
    double most = 0;
    for (int i = 0; i < 4000; ++i) {
      const double z = rng.uniform(-1, 1), turn = rng.uniform(0, 2 * kPi), s = std::sqrt(1 - z * z);
      const Eigen::Vector3d pull = kGravity * Eigen::Vector3d(s * std::cos(turn), s * std::sin(turn), z);
      most = std::max(most, suction_share(suction, kDown, 1, centre, pull));
    }
    EXPECT_LE(most, bound * (1 + 1e-9));
    EXPECT_GE(most, 0.97 * bound);
  }
}

TEST(SampleSuctionGrasps, SealOnBoxesFromEverySideThatIsLargeEnough) {
  const Eigen::Vector3d size(0.06, 0.1, 0.03);  // a cup of 2 cm fits on the two large faces only
  const LinkShape box = shape_at(Box{size}, pose_from_xyz_rpy({0.1, 0.2, 0}, {0.3, 0.2, 0.1}));
  const Suction suction = one_cup(0.02);
  SuctionSamplerOptions options;
  options.max_grasps = 100000;
  const SampledSuctionGrasps found = sample_suction_grasps({box}, cup_hand(suction), 0.3, options);
  ASSERT_GT(found.grasps.size(), 50u);
  for (const Grasp& grasp : found.grasps) {
    const Eigen::Vector3d way = box.T_link_shape.linear().transpose() * grasp.T_object_hand.linear() * kDown;
    EXPECT_NEAR(std::abs(way.z()), 1, 1e-6);
    EXPECT_EQ(judged(suction, box, grasp.T_object_hand), "");
    EXPECT_NEAR(seal_gap({box}, grasp.T_object_hand, kDown, suction), kSuctionStandoff, 1e-5);
  }
  EXPECT_GT(found.unsealed, 0);
  // The best is over the middle of a large face.
  const Pose best = box.T_link_shape.inverse() * found.grasps.front().T_object_hand;
  EXPECT_NEAR(best.translation().head<2>().norm(), 0, 1e-6);
}

TEST(SampleSuctionGrasps, SealOnRoundBodiesUpToTheSagitta) {
  const double r = 0.012;
  for (const double R : {0.02, 0.03, 0.05, 0.08}) {
    const Suction suction = one_cup(r, 0.0015);
    const bool fits = sagitta(R, r) + kSuctionStandoff < suction.max_gap;
    const LinkShape ball = shape_at(Sphere{R});
    const auto found = sample_suction_grasps({ball}, cup_hand(suction));
    EXPECT_EQ(!found.grasps.empty(), fits) << R;
    for (const Grasp& grasp : found.grasps) EXPECT_EQ(judged(suction, ball, grasp.T_object_hand), "") << R;
    const LinkShape rod = shape_at(Cylinder{R, 0.2});
    for (const Grasp& grasp : sample_suction_grasps({rod}, cup_hand(suction)).grasps)
      EXPECT_EQ(judged(suction, rod, grasp.T_object_hand), "") << R;
  }
}

TEST(SampleSuctionGrasps, SayWhatIsTooSmallAndTooHeavy) {
  const Suction suction = one_cup(0.02);
  const SampledSuctionGrasps small = sample_suction_grasps({shape_at(Box{{0.03, 0.03, 0.03}})}, cup_hand(suction), 0.1);
  EXPECT_TRUE(small.grasps.empty());
  EXPECT_EQ(small.too_heavy, 0);
  EXPECT_GT(small.unsealed, 0);
  const LinkShape box = shape_at(Box{{0.1, 0.1, 0.02}});
  // Centred, 1 cm deep, rho = 2 cm: slipping decides, with sqrt(1 + 1 / 0.25) = 2.236 times the weight, twice over.
  const double held = suction.force() / (2 * kGravity * std::sqrt(5.0)) * kSuctionUsed;
  EXPECT_FALSE(sample_suction_grasps({box}, cup_hand(suction), 0.995 * held).grasps.empty());
  const SampledSuctionGrasps heavy = sample_suction_grasps({box}, cup_hand(suction), 1.005 * held);
  EXPECT_TRUE(heavy.grasps.empty());
  EXPECT_GT(heavy.too_heavy, 0);
  EXPECT_NEAR(heavy.least_share, 1.005 * kSuctionUsed, 1e-3);
}

TEST(SampleSuctionGrasps, AllCupsSeal) {
  Suction two = one_cup(0.01);
  two.cups = {{{0.03, 0, 0}, 0.01}, {{-0.03, 0, 0}, 0.01}};
  const LinkShape bar = shape_at(Box{{0.1, 0.03, 0.03}});  // both only along x
  const auto found = sample_suction_grasps({bar}, cup_hand(two));
  ASSERT_FALSE(found.grasps.empty());
  for (const Grasp& grasp : found.grasps) {
    EXPECT_NEAR(std::abs((grasp.T_object_hand.linear() * Eigen::Vector3d::UnitX()).x()), 1, 0.1);
    EXPECT_EQ(judged(two, bar, grasp.T_object_hand), "");
  }
}

TEST(SuctionHand, HasNoFingers) {
  const Hand hand = cup_hand(one_cup(0.02));
  EXPECT_EQ(hand.pregrasp_opening(0), 0);
  EXPECT_EQ(hand.share_open(0), 0);
  EXPECT_TRUE(hand.joint_values(0.0).empty());
  EXPECT_THROW(hand.check_fingers(), InvalidInput);
  EXPECT_THROW(hand.shapes(0), InvalidInput);
  Hand both = hand;
  both.max_opening = 0.1;
  EXPECT_THROW(both.check(), InvalidInput);
  Suction off = one_cup(0.02);
  off.cups[0].position = {0, 0, 0.01};
  EXPECT_THROW(cup_hand(off), InvalidInput);
  off = one_cup(0.02);
  off.vacuum = 2e5;
  EXPECT_THROW(cup_hand(off), InvalidInput);
}

}  // namespace
}  // namespace mmgrasp
