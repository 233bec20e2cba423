#include "mmgrasp/grasp/sample_grasps.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <variant>

#include "grasp/placed_shape.hpp"
#include "mmgrasp/core/error.hpp"

namespace mmgrasp {
namespace {

constexpr double kPi = 3.14159265358979323846;

using test::shape_at;
using test::wide_gripper;

GraspSamplerOptions all_kept() {
  GraspSamplerOptions options;
  options.max_grasps = 1000000;
  return options;
}

Eigen::Vector3d closing_in_object(const Grasp& grasp, const Hand& gripper) {
  return grasp.T_object_hand.linear() * gripper.closing;
}

Eigen::Vector3d approach_in_object(const Grasp& grasp, const Hand& gripper) {
  return grasp.T_object_hand.linear() * gripper.approach;
}

bool tips_flush(const Grasp& grasp) {
  return std::get<ContactPairProvenance>(grasp.provenance).tips_flush;
}

/// Those at the positions that the options ask for.
std::vector<Grasp> at_positions(std::vector<Grasp> grasps) {
  grasps.erase(std::remove_if(grasps.begin(), grasps.end(), tips_flush), grasps.end());
  return grasps;
}

TEST(SampleGrasps, BoxContactsLieOnOppositeFacesAtTheBoxesSize) {
  const Eigen::Vector3d size(0.03, 0.05, 0.08);
  const Pose T = pose_from_xyz_rpy({0.1, -0.2, 0.3}, {0.4, -0.7, 1.1});
  const Hand gripper = wide_gripper();
  const SampledGrasps sampled = sample_grasps({shape_at(Box{size}, T)}, gripper, all_kept());
  const std::vector<Grasp> grasps = at_positions(sampled.grasps);
  ASSERT_EQ(grasps.size(), 3u * 9 * 8 * 2);
  EXPECT_EQ(sampled.too_wide, 0);
  std::set<int> axes;
  for (const Grasp& grasp : grasps) {
    const Eigen::Vector3d closing = T.linear().transpose() * closing_in_object(grasp, gripper);
    Eigen::Index axis;
    ASSERT_NEAR(closing.cwiseAbs().maxCoeff(&axis), 1, 1e-12);
    axes.insert(static_cast<int>(axis));
    EXPECT_NEAR(grasp.opening, size[axis], 1e-12);
    for (const double side : {-0.5, 0.5}) {
      const Eigen::Vector3d contact = T.inverse() * grasp.T_object_hand.translation() + side * grasp.opening * closing;
      EXPECT_NEAR(std::abs(contact[axis]), size[axis] / 2, 1e-12);
      for (const int other : {(axis + 1) % 3, (axis + 2) % 3}) EXPECT_LT(std::abs(contact[other]), size[other] / 2);
    }
  }
  EXPECT_EQ(axes.size(), 3u);
}

TEST(SampleGrasps, ToolAxesFollowTheGrippersConventions) {
  Hand gripper = wide_gripper();
  gripper.approach = Eigen::Vector3d::UnitZ();
  gripper.closing = -Eigen::Vector3d::UnitX();
  const Eigen::Vector3d size(0.03, 0.2, 0.2);  // only x can be held
  const auto grasps = sample_grasps({shape_at(Box{size})}, gripper, all_kept()).grasps;
  ASSERT_FALSE(grasps.empty());
  int from_above = 0;
  for (const Grasp& grasp : grasps) {
    const Eigen::Matrix3d R = grasp.T_object_hand.linear();
    EXPECT_LT((R.transpose() * R - Eigen::Matrix3d::Identity()).norm(), 1e-12);
    EXPECT_NEAR(R.determinant(), 1, 1e-12);
    EXPECT_NEAR(std::abs(R.col(0).x()), 1, 1e-12);  // tcp x, the closing axis up to sign, joins the contacts
    EXPECT_NEAR(R.col(2).x(), 0, 1e-12);            // tcp z is the approach, across it
    from_above += (R.col(2) + Eigen::Vector3d::UnitZ()).norm() < 1e-9;
  }
  EXPECT_EQ(from_above, 9 * 2);  // every pad position, both flips
}

TEST(SampleGrasps, EveryGraspComesWithItsFlip) {
  const Hand gripper = wide_gripper();
  const auto grasps = sample_grasps({shape_at(Cylinder{0.02, 0.06})}, gripper, all_kept()).grasps;
  ASSERT_FALSE(grasps.empty());
  for (const Grasp& grasp : grasps) {
    const Eigen::Matrix3d flipped =
        grasp.T_object_hand.linear() * Eigen::AngleAxisd(kPi, gripper.approach).toRotationMatrix();
    const bool found = std::any_of(grasps.begin(), grasps.end(), [&](const Grasp& other) {
      return (other.T_object_hand.translation() - grasp.T_object_hand.translation()).norm() < 1e-9 &&
             (other.T_object_hand.linear() - flipped).norm() < 1e-9 && other.quality == grasp.quality;
    });
    EXPECT_TRUE(found);
  }
}

TEST(SampleGrasps, StandoffMovesTheToolFrameBackAlongTheApproach) {
  const Hand gripper = wide_gripper();
  GraspSamplerOptions options = all_kept();
  options.positions = 1;
  options.standoff = 0.015;
  for (const Grasp& grasp : sample_grasps({shape_at(Box{{0.04, 0.05, 0.06}})}, gripper, options).grasps) {
    EXPECT_LT((grasp.T_object_hand.translation() + 0.015 * approach_in_object(grasp, gripper)).norm(), 1e-12);
  }
}

/// How far the tips of the pads reach beyond a convex body's far face along the approach, by the body's reach in a
/// direction, both about the object's origin.
template <typename Reach>
double beyond_far_face(const Grasp& grasp, const Hand& hand, const Reach& reach) {
  const Eigen::Vector3d approach = approach_in_object(grasp, hand);
  return approach.dot(grasp.T_object_hand.translation()) + hand.finger_depth / 2 - reach(approach);
}

// Pads that stay farther before the contacts than they are long meet nothing, unless the face reaches so far back.
TEST(SampleGrasps, PadsMeetTheFacesWhateverTheStandoff) {
  const Hand gripper = wide_gripper();
  GraspSamplerOptions options = all_kept();
  for (const double standoff : {0.06, 0.1, 10.0}) {
    options.standoff = standoff;
    EXPECT_TRUE(sample_grasps({shape_at(Box{Eigen::Vector3d::Constant(0.04)})}, gripper, options).grasps.empty());
    EXPECT_TRUE(sample_grasps({shape_at(Sphere{0.04})}, gripper, options).grasps.empty());
    EXPECT_TRUE(sample_grasps({shape_at(Cylinder{0.02, 0.06})}, gripper, options).grasps.empty());
  }
  const Eigen::Vector3d half(0.02, 0.02, 0.1);
  for (const double standoff : {0.0, 0.012, 0.03, 0.08}) {
    options.standoff = standoff;
    const std::vector<Grasp> grasps = sample_grasps({shape_at(Box{2 * half})}, gripper, options).grasps;
    EXPECT_FALSE(grasps.empty()) << standoff;
    for (const Grasp& grasp : grasps) {
      const Eigen::Vector3d closing = closing_in_object(grasp, gripper), approach = approach_in_object(grasp, gripper);
      const Eigen::Vector3d across = closing.cross(approach);
      int on_face = 0;
      for (int i = 0; i < 41 * 41; ++i) {
        const Eigen::Vector3d on_pad = approach * 0.015 * (i / 41 - 20) / 20 + across * 0.01 * (i % 41 - 20) / 20;
        const Eigen::Vector3d p = grasp.T_object_hand.translation() + on_pad;
        on_face += ((p - closing.dot(p) * closing).cwiseAbs() - half).maxCoeff() <= 1e-9;
      }
      EXPECT_GT(on_face, 0) << standoff;
    }
  }
}

TEST(SampleGrasps, TipsAreFlushWithTheFarFaceOfAFlatBox) {
  Hand gripper = wide_gripper();
  gripper.finger_depth = 0.04;
  const SampledGrasps sampled = sample_grasps({shape_at(Box{{0.05, 0.04, 0.016}})}, gripper, all_kept());
  int from_above = 0;
  for (const Grasp& grasp : sampled.grasps) {
    if (!tips_flush(grasp)) continue;
    if ((approach_in_object(grasp, gripper) + Eigen::Vector3d::UnitZ()).norm() > 1e-9) continue;
    ++from_above;
    EXPECT_NEAR(grasp.T_object_hand.translation().z(), 0.02 - 0.008, 1e-12);
    EXPECT_NEAR(grasp.opening, std::abs(closing_in_object(grasp, gripper).x()) > 0.5 ? 0.05 : 0.04, 1e-12);
  }
  EXPECT_EQ(from_above, 2 * 3 * 2);  // two closing axes, three positions across, both flips: none twice
}

TEST(SampleGrasps, TipsReachNoFartherThanEveryBodyWhereTheyAreFlush) {
  const Pose T = pose_from_xyz_rpy({0.1, -0.2, 0.3}, {0.4, -0.7, 1.1});
  const Hand gripper = wide_gripper();
  const auto expect_flush = [&](const Shape& shape, const auto& reach) {
    const SampledGrasps sampled = sample_grasps({shape_at(shape, T)}, gripper, all_kept());
    const auto placed = [&](const Eigen::Vector3d& direction) {
      return direction.dot(T.translation()) + reach(Eigen::Vector3d(T.linear().transpose() * direction));
    };
    int flush = 0;
    std::set<std::array<long, 12>> places;
    for (const Grasp& grasp : sampled.grasps) {
      const double beyond = beyond_far_face(grasp, gripper, placed);
      if (!tips_flush(grasp)) continue;
      ++flush;
      EXPECT_NEAR(beyond, 0, 1e-12);
      std::array<long, 12> place{};
      for (int i = 0; i < 12; ++i) place[i] = std::lround(1e6 * grasp.T_object_hand(i % 3, i / 3));
      EXPECT_TRUE(places.insert(place).second) << "listed twice";
    }
    EXPECT_GT(flush, 0);
    EXPECT_EQ(sampled.tips_flush, flush);
  };
  expect_flush(Box{{0.05, 0.04, 0.016}},
               [](const Eigen::Vector3d& d) { return d.cwiseAbs().dot(Eigen::Vector3d(0.025, 0.02, 0.008)); });
  expect_flush(Sphere{0.01}, [](const Eigen::Vector3d&) { return 0.01; });
  expect_flush(Cylinder{0.03, 0.01},
               [](const Eigen::Vector3d& d) { return 0.03 * d.head<2>().norm() + 0.005 * std::abs(d.z()); });
  expect_flush(Capsule{0.008, 0.05}, [](const Eigen::Vector3d& d) { return 0.008 + 0.025 * std::abs(d.z()); });
}

TEST(SampleGrasps, WhereTheTipsStayWithinTheObjectNoneAreMadeFlush) {
  // The outermost of the positions are flush by themselves.
  const SampledGrasps thick = sample_grasps({shape_at(Box{{0.05, 0.2, 0.2}})}, wide_gripper(), all_kept());
  EXPECT_EQ(thick.tips_flush, 0);
  for (const Grasp& grasp : thick.grasps) EXPECT_FALSE(tips_flush(grasp));
  // A standoff that keeps the tips inside is enough.
  GraspSamplerOptions options = all_kept();
  options.positions = 1;
  options.standoff = 0.012;
  EXPECT_EQ(sample_grasps({shape_at(Sphere{0.004})}, wide_gripper(), options).tips_flush, 0);
  options.standoff = 0.010;
  EXPECT_GT(sample_grasps({shape_at(Sphere{0.004})}, wide_gripper(), options).tips_flush, 0);
}

TEST(SampleGrasps, FlushGraspsOfAFlatBoxAreAmongThoseKept) {
  Hand gripper = wide_gripper();
  gripper.finger_depth = 0.04;
  const SampledGrasps sampled = sample_grasps({shape_at(Box{{0.05, 0.04, 0.016}})}, gripper);
  const auto from_above = std::count_if(sampled.grasps.begin(), sampled.grasps.end(), [&](const Grasp& grasp) {
    return tips_flush(grasp) && (approach_in_object(grasp, gripper) + Eigen::Vector3d::UnitZ()).norm() < 1e-9;
  });
  EXPECT_GE(from_above, 4);  // both closing axes, both flips
}

TEST(SampleGrasps, CylinderWidthsAreDiameterOrLength) {
  const double radius = 0.025, length = 0.09;
  const Hand gripper = wide_gripper();
  const auto grasps = at_positions(sample_grasps({shape_at(Cylinder{radius, length})}, gripper, all_kept()).grasps);
  int across = 0, along = 0;
  for (const Grasp& grasp : grasps) {
    const Eigen::Vector3d closing = closing_in_object(grasp, gripper), middle = grasp.T_object_hand.translation();
    if (std::abs(closing.z()) < 0.5) {
      ++across;
      EXPECT_NEAR(closing.z(), 0, 1e-12);
      EXPECT_NEAR(grasp.opening, 2 * radius, 1e-12);
      EXPECT_NEAR(middle.head<2>().norm(), 0, 1e-12);
      EXPECT_LT(std::abs(middle.z()), length / 2);
    } else {
      ++along;
      EXPECT_NEAR(grasp.opening, length, 1e-12);
      EXPECT_LT(middle.head<2>().norm(), radius);
      EXPECT_NEAR(middle.z(), 0, 1e-12);
    }
  }
  EXPECT_EQ(across, 3 * 8 * 8 * 2);
  EXPECT_EQ(along, 9 * 8 * 2);
}

TEST(SampleGrasps, SphereAndCapsuleMatchTheirClosedForms) {
  const Hand gripper = wide_gripper();
  const Pose T = pose_from_xyz_rpy({0, 0, 0.5}, {0, 0, 0});
  const auto sphere = sample_grasps({shape_at(Sphere{0.03}, T)}, gripper, all_kept()).grasps;
  ASSERT_EQ(sphere.size(), (3u + 8 * 3) * 8 * 2);
  for (const Grasp& grasp : sphere) {
    EXPECT_NEAR(grasp.opening, 0.06, 1e-12);
    EXPECT_NEAR((grasp.T_object_hand.translation() - T.translation()).norm(), 0, 1e-12);
  }
  for (const Grasp& grasp : sample_grasps({shape_at(Capsule{0.02, 0.05})}, gripper, all_kept()).grasps) {
    const bool across = std::abs(closing_in_object(grasp, gripper).z()) < 0.5;
    EXPECT_NEAR(grasp.opening, across ? 0.04 : 0.09, 1e-12);
  }
}

TEST(SampleGrasps, CountsPairsWiderThanTheOpening) {
  Hand gripper = wide_gripper();
  gripper.max_opening = 0.06;
  const SampledGrasps sampled = sample_grasps({shape_at(Box{{0.05, 0.061, 0.2}})}, gripper, all_kept());
  const std::vector<Grasp> grasps = at_positions(sampled.grasps);
  EXPECT_EQ(sampled.too_wide, 2 * 9);  // nine pad positions on each of two pairs of faces
  EXPECT_EQ(grasps.size(), 9u * 8 * 2);
  for (const Grasp& grasp : grasps) EXPECT_LE(grasp.opening, gripper.max_opening);
  gripper.max_opening = 0.04;
  const SampledGrasps none = sample_grasps({shape_at(Box{{0.05, 0.061, 0.2}})}, gripper);
  EXPECT_TRUE(none.grasps.empty());
  EXPECT_EQ(none.too_wide, 3 * 9);
}

TEST(SampleGrasps, QualityIsSortedAndPrefersTheMiddle) {
  const Hand gripper = wide_gripper();
  const auto grasps = sample_grasps({shape_at(Box{{0.03, 0.15, 0.15}})}, gripper, all_kept()).grasps;
  for (std::size_t i = 1; i < grasps.size(); ++i) EXPECT_GE(grasps[i - 1].quality, grasps[i].quality);
  for (const Grasp& grasp : grasps) {
    EXPECT_GT(grasp.quality, 0);
    EXPECT_LE(grasp.quality, 1);
  }
  // Same approach: through the centre of mass beats off to the side at the same depth.
  const auto quality_at = [&](const Eigen::Vector3d& tcp) {
    for (const Grasp& grasp : grasps)
      if ((grasp.T_object_hand.translation() - tcp).norm() < 1e-9 &&
          (approach_in_object(grasp, gripper) + Eigen::Vector3d::UnitZ()).norm() < 1e-9)
        return grasp.quality;
    return -1.0;
  };
  const double edge = 0.075 - 0.03 / 2;  // the pad is flush with the edge
  ASSERT_GT(quality_at({0, edge, 0}), 0);
  EXPECT_GT(quality_at({0, 0, 0}), quality_at({0, edge, 0}));
  // Less material between the palm and the pads is better than more, at the same distance from the centre.
  EXPECT_GT(quality_at({0, 0, edge}), quality_at({0, 0, -edge}));
}

TEST(SampleGrasps, LimitKeepsDirectionsSpread) {
  const Hand gripper = wide_gripper();
  GraspSamplerOptions options;
  options.max_grasps = 48;  // three closing axes, eight approaches, two flips
  const auto grasps = sample_grasps({shape_at(Box{{0.04, 0.05, 0.06}})}, gripper, options).grasps;
  ASSERT_EQ(grasps.size(), 48u);
  for (std::size_t i = 0; i < grasps.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      EXPECT_GT(rotation_distance(grasps[i].T_object_hand, grasps[j].T_object_hand), 0.5) << i << " " << j;
}

TEST(SampleGrasps, RefusesBadInput) {
  const Hand gripper = wide_gripper();
  EXPECT_THROW(sample_grasps({}, gripper), InvalidInput);
  EXPECT_THROW(sample_grasps({shape_at(Plane{})}, gripper), InvalidInput);
  EXPECT_THROW(sample_grasps({shape_at(Box{{0.1, 0, 0.1}})}, gripper), InvalidInput);
  Hand crooked = gripper;
  crooked.closing = crooked.approach;
  EXPECT_THROW(sample_grasps({shape_at(Sphere{0.02})}, crooked), InvalidInput);
  for (int field = 0; field < 5; ++field) {
    GraspSamplerOptions options;
    if (field == 0) options.approaches = 0;
    if (field == 1) options.positions = 0;
    if (field == 2) options.mesh_samples = -1;
    if (field == 3) options.max_grasps = 0;
    if (field == 4) options.friction = 0;
    EXPECT_THROW(sample_grasps({shape_at(Sphere{0.02})}, gripper, options), InvalidInput) << field;
  }
}

}  // namespace
}  // namespace mmgrasp
