#include "mmgrasp/grasp/synthesize_grasps.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "scanned_object.hpp"

namespace mmgrasp {
namespace {

using namespace test;
using Eigen::Vector3d;

/// Scanned once for all tests: 40 x 70 x 60 mm on a table, turned by 0.3 rad.
const Vector3d kSize(0.04, 0.07, 0.06);
const Pose kBoxPose = at(0.01, -0.005, 0.03, 0.3);
const ProbabilisticSdf& box_map() {
  static const ProbabilisticSdf map = scan({table_plane(), {Box{kSize}, kBoxPose}});
  return map;
}

SynthesisOptions on_table() {
  SynthesisOptions options;
  options.table = 0.0;
  options.threads = 1;
  return options;
}

/// Distance from a point to a box at the origin, negative inside.
double box_distance(const Vector3d& p, const Vector3d& half) {
  const Vector3d d = p.cwiseAbs() - half;
  return d.cwiseMax(0).norm() + std::min(0.0, d.maxCoeff());
}

/// Least distance between the surface of the hand's boxes, sampled every 2 mm, and the true box; and the lowest height.
std::pair<double, double> clearance_of(const Hand& hand, double opening, const Pose& T_world_hand) {
  double least = 1, lowest = 1;
  for (const LinkShape& shape : hand.shapes(opening)) {
    const Vector3d size = std::get<Box>(shape.shape).size;
    const Pose T = T_world_hand * shape.T_link_shape;
    const Eigen::Vector3i n = (size / 0.002).array().ceil().cast<int>();
    for (int i = 0; i <= n.x(); ++i) {
      for (int j = 0; j <= n.y(); ++j) {
        for (int k = 0; k <= n.z(); ++k) {
          const Vector3d share(1.0 * i / n.x() - 0.5, 1.0 * j / n.y() - 0.5, 1.0 * k / n.z() - 0.5);
          const Vector3d p = T * size.cwiseProduct(share);
          least = std::min(least, box_distance(kBoxPose.inverse() * p, kSize / 2));
          lowest = std::min(lowest, p.z());
        }
      }
    }
  }
  return {least, lowest};
}

std::size_t causes(const SynthesisCounts& c) {
  return c.missed + c.uneven + c.slipping + c.uncertain + c.collision + c.table + c.arm + c.near_better;
}

}  // namespace

TEST(SynthesizeGrasps, BoxIsHeldAcrossItsFaces) {
  const GraspSynthesis found = synthesize_grasps(box_map(), test_hand(), on_table());
  ASSERT_EQ(found.outcome, Outcome::solved) << found.summary();
  ASSERT_EQ(found.grasps.size(), found.ratings.size());
  EXPECT_LT((found.object.centre - kBoxPose.translation()).norm(), 0.003);
  EXPECT_NEAR(found.object.longest, 0.07, 0.006);
  const Hand hand = test_hand();
  for (std::size_t i = 0; i < found.grasps.size(); ++i) {
    const Grasp& grasp = found.grasps[i];
    const GraspRating& rating = found.ratings[i];
    if (i > 0) {
      EXPECT_LE(grasp.quality, found.grasps[i - 1].quality);
    }
    EXPECT_EQ(grasp.quality, rating.success.probability);
    // Across 40 or 70 mm, closing along the true face's normal within the cone of a coefficient of 0.5.
    const Vector3d axis = kBoxPose.linear().transpose() * grasp.T_object_hand.linear() * hand.closing;
    const int side = std::abs(axis.x()) > std::abs(axis.y()) ? 0 : 1;
    EXPECT_GT(std::abs(axis[side]), std::cos(std::atan(0.5)));
    EXPECT_NEAR(grasp.opening, kSize[side], 0.025);
    // Patches lie on the true faces, with their normals.
    ASSERT_EQ(rating.patches.size(), 2u);
    for (const ContactPatch& patch : rating.patches) {
      const Vector3d p = kBoxPose.inverse() * patch.point, n = kBoxPose.linear().transpose() * patch.normal;
      EXPECT_NEAR(std::abs(p[side]), kSize[side] / 2, 0.0015);
      EXPECT_GT(n[side] * (p[side] > 0 ? 1 : -1), 0.98);
    }
    // The open hand keeps off the true box and the table.
    const auto [least, lowest] = clearance_of(hand, rating.pretouch_opening, grasp.T_object_hand);
    EXPECT_GT(least, 0.001);
    EXPECT_GT(lowest, 0.0);
    EXPECT_GE(-(grasp.T_object_hand.linear() * hand.approach).z(), std::cos(1.05) - 1e-9);
  }
  EXPECT_GT(found.grasps[0].quality, 0.9);
}

TEST(SynthesizeGrasps, EverySampleIsCountedOnce) {
  for (const double tilt : {0.2, 1.05, 3.1}) {
    SynthesisOptions options = on_table();
    options.max_tilt = tilt;
    options.max_grasps = 5;
    const GraspSynthesis found = synthesize_grasps(box_map(), test_hand(), options);
    const SynthesisCounts& c = found.counts;
    EXPECT_EQ(c.evaluated, causes(c) + found.grasps.size());
    EXPECT_LE(c.evaluated, 200u);
    EXPECT_GE(c.drawn, c.no_opposite + c.too_wide + c.too_thin + c.tilted);
    // What was drawn and not rejected was evaluated in the first search; the second adds at most a third.
    EXPECT_LE(c.drawn - c.no_opposite - c.too_wide - c.too_thin - c.tilted, c.evaluated);
  }
}

TEST(SynthesizeGrasps, SameAnswerAtAnyThreadCount) {
  SynthesisOptions options = on_table();
  const GraspSynthesis one = synthesize_grasps(box_map(), test_hand(), options);
  options.threads = 3;
  const GraspSynthesis three = synthesize_grasps(box_map(), test_hand(), options);
  ASSERT_EQ(one.grasps.size(), three.grasps.size());
  for (std::size_t i = 0; i < one.grasps.size(); ++i) {
    EXPECT_EQ(one.grasps[i].T_object_hand.matrix(), three.grasps[i].T_object_hand.matrix());
    EXPECT_EQ(one.grasps[i].quality, three.grasps[i].quality);
  }
  options.seed = 2;
  const GraspSynthesis other = synthesize_grasps(box_map(), test_hand(), options);
  ASSERT_FALSE(other.grasps.empty());
  EXPECT_NE(one.grasps[0].T_object_hand.matrix(), other.grasps[0].T_object_hand.matrix());
}

TEST(SynthesizeGrasps, SphereIsHeldThroughItsMiddle) {
  const Vector3d middle(0, 0, 0.03);
  const ProbabilisticSdf map = scan({table_plane(), {Sphere{0.03}, at(0, 0, 0.03)}});
  const GraspSynthesis found = synthesize_grasps(map, test_hand(), on_table());
  ASSERT_EQ(found.outcome, Outcome::solved) << found.summary();
  for (const GraspRating& rating : found.ratings) {
    for (const ContactPatch& patch : rating.patches) {
      // The mean of a patch on a sphere lies within, its normal points away from the middle.
      EXPECT_NEAR((patch.point - middle).norm(), 0.029, 0.0015);
      EXPECT_GT(patch.normal.dot((patch.point - middle).normalized()), 0.985);
    }
    const Vector3d a = rating.patches[0].point, b = rating.patches[1].point;
    const double off = (middle - a).cross(b - a).norm() / (b - a).norm();
    EXPECT_LT(off, 0.03 * std::sin(std::atan(0.5)) + 0.002);
  }
  EXPECT_GT(found.ratings[0].success.probability, 0.85);
}

TEST(SynthesizeGrasps, TooWideForTheHandIsToldByCause) {
  Hand narrow = test_hand();
  narrow.max_opening = 0.03;
  const GraspSynthesis found = synthesize_grasps(box_map(), narrow, on_table());
  EXPECT_EQ(found.outcome, Outcome::not_found);
  EXPECT_TRUE(found.grasps.empty());
  EXPECT_EQ(found.counts.evaluated, causes(found.counts));
  EXPECT_GT(found.counts.too_wide, found.counts.drawn / 3);
  EXPECT_NE(found.summary().find("no grasp"), std::string::npos);
  EXPECT_NEAR(found.opens, 0.03, 1e-9);
  EXPECT_GT(found.median_too_wide, kSize.x() - 0.002);  // of walls 40 and 70 mm apart
  EXPECT_LT(found.median_too_wide, kSize.y() + 0.002);
  EXPECT_NE(found.summary().find("or more apart, and the hand opens 30 mm"), std::string::npos) << found.summary();
}

TEST(SynthesizeGrasps, NeighboursAreKeptClearOf) {
  // Walls of 60 mm stand 15 mm beside the box's long sides: only the short ones are left, and nothing is pierced.
  const Pose left = kBoxPose * at(0.04, 0, 0), right = kBoxPose * at(-0.04, 0, 0);
  const Box wall{{0.01, 0.09, 0.06}};
  const ProbabilisticSdf map =
      scan({table_plane(), {Box{kSize}, kBoxPose}, {wall, left}, {wall, right}}, 0.0005, false, 14);
  SynthesisOptions options = on_table();
  options.samples = 1000;
  options.object = Eigen::AlignedBox3d(Vector3d(-0.06, -0.06, 0), Vector3d(0.08, 0.06, 0.07));
  const GraspSynthesis found = synthesize_grasps(map, test_hand(), options);
  EXPECT_GT(found.counts.collision, 0u);
  ASSERT_FALSE(found.grasps.empty());
  for (std::size_t i = 0; i < found.grasps.size(); ++i) {
    for (const LinkShape& shape : test_hand().shapes(found.ratings[i].pretouch_opening)) {
      const Pose T = found.grasps[i].T_object_hand * shape.T_link_shape;
      const Vector3d half = std::get<Box>(shape.shape).size / 2;
      for (const Pose& T_wall : {left, right}) {
        for (int k = 0; k < 1000; ++k) {
          const Vector3d share(k % 10 / 4.5 - 1, k / 10 % 10 / 4.5 - 1, k / 100 / 4.5 - 1);
          EXPECT_GT(box_distance(T_wall.inverse() * (T * half.cwiseProduct(share)), wall.size / 2), 0.0);
        }
      }
    }
  }
}

TEST(SynthesizeGrasps, ArmsChooseAmongTheGrasps) {
  SynthesisOptions options = on_table();
  const ArmReach none = [](const Pose&, Eigen::VectorXd&) { return Rejection::unreachable; };
  const GraspSynthesis lost = synthesize_grasps(box_map(), test_hand(), options, {}, none);
  EXPECT_EQ(lost.outcome, Outcome::not_found);
  EXPECT_GT(lost.arm.unreachable, 0u);
  EXPECT_EQ(lost.counts.arm, lost.arm.total());
  EXPECT_EQ(lost.counts.evaluated, causes(lost.counts));

  const ArmReach half = [](const Pose& T, Eigen::VectorXd& q) {
    q = Eigen::VectorXd::Constant(1, T.translation().x());
    return T.translation().x() < 0.01 ? Rejection::none : Rejection::scene;
  };
  const GraspSynthesis found = synthesize_grasps(box_map(), test_hand(), options, {}, half);
  ASSERT_EQ(found.outcome, Outcome::solved);
  EXPECT_EQ(found.counts.arm, found.arm.scene);
  for (std::size_t i = 0; i < found.grasps.size(); ++i) {
    EXPECT_LT(found.grasps[i].T_object_hand.translation().x(), 0.01);
    EXPECT_EQ(found.ratings[i].q[0], found.grasps[i].T_object_hand.translation().x());
  }
}

TEST(SynthesizeGrasps, MoreNoiseMakesGraspsLessProbable) {
  const std::vector<PlacedShape> scene{table_plane(), {Box{kSize}, kBoxPose}};
  SynthesisOptions options = on_table();
  options.success = {};
  options.success.angle_weight = options.success.placement_weight = options.success.centring_weight = 0;
  options.success.certainty_weight = 1;
  double before = 1;
  for (const double sigma : {0.0005, 0.001, 0.002}) {
    const GraspSynthesis found = synthesize_grasps(scan(scene, sigma, true), test_hand(), options);
    ASSERT_EQ(found.outcome, Outcome::solved) << found.summary();
    EXPECT_LT(found.grasps[0].quality, before);
    before = found.grasps[0].quality;
  }
}

TEST(SynthesizeGrasps, BadInputHasOneMessage) {
  const auto message = [](const ProbabilisticSdf& map, const Hand& hand, const SynthesisOptions& options) {
    try {
      synthesize_grasps(map, hand, options);
    } catch (const InvalidInput& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(message(ProbabilisticSdf(), test_hand(), on_table()).find("map = 0 frames: has no surface"),
            std::string::npos);
  SynthesisOptions elsewhere = on_table();
  elsewhere.object = Eigen::AlignedBox3d(Vector3d(1, 1, 1), Vector3d(2, 2, 2));
  EXPECT_NE(message(box_map(), test_hand(), elsewhere).find("object = 0 points"), std::string::npos);
  SynthesisOptions above = on_table();
  above.table = 0.5;
  EXPECT_NE(message(box_map(), test_hand(), above).find("table = 0 points"), std::string::npos);
  SynthesisOptions none = on_table();
  none.samples = 0;
  EXPECT_NE(message(box_map(), test_hand(), none).find("samples"), std::string::npos);
  EXPECT_THROW(closing_line({}), InvalidInput);
}

TEST(SynthesizeGrasps, StopsWhenAsked) {
  Monitor monitor;
  monitor.stop.stop();
  EXPECT_EQ(synthesize_grasps(box_map(), test_hand(), on_table(), monitor).outcome, Outcome::stopped);
}

}  // namespace mmgrasp
