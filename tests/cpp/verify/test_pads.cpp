#include <gtest/gtest.h>

#include <cmath>

#include "mmgrasp/geometry/mesh.hpp"
#include "mmgrasp/verify/plan_check.hpp"

namespace mmgrasp::verify {
namespace {

const CheckedPads kPads{Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY(), 0.1, 0.04, 0.02, 0.01};

LinkShape at(const Shape& shape, double x = 0, double y = 0, double z = 0) {
  LinkShape placed;
  placed.shape = shape;
  placed.T_link_shape.translation() << x, y, z;
  return placed;
}

std::string unlike(const std::vector<LinkShape>& part, double opening, double y = 0) {
  CheckedGrasp grasp;
  grasp.T_object_hand.translation().y() = y;
  grasp.opening = opening;
  return pads_unlike_grasp(kPads, part, grasp);
}

TEST(PadsUnlikeGrasp, ABlockIsHeldAtItsWidth) {
  const std::vector<LinkShape> block{at(Box{{0.05, 0.05, 0.05}})};
  EXPECT_EQ(unlike(block, 0.05), "");
  EXPECT_EQ(unlike(block, 0.052), "");
  EXPECT_NE(unlike(block, 0.04).find("meet the part at 0.05"), std::string::npos);
  EXPECT_NE(unlike(block, 0.06).find("meet the part at 0.05"), std::string::npos);
}

TEST(PadsUnlikeGrasp, FingersThatCloseAlikeMeetTheBlockOnBothSides) {
  const std::vector<LinkShape> block{at(Box{{0.05, 0.05, 0.05}})};
  for (const double y : {-0.005, 0.005})
    EXPECT_NE(unlike(block, 0.05, y).find("0.005 m beside the middle"), std::string::npos) << unlike(block, 0.05, y);
  EXPECT_EQ(unlike(block, 0.05, 0.002), "");
}

TEST(PadsUnlikeGrasp, ABlockBesideTheHandHasNoWidth) {
  const std::vector<LinkShape> block{at(Box{{0.02, 0.02, 0.02}})};
  CheckedGrasp beside;
  beside.opening = 0.02;
  beside.T_object_hand.translation().z() = 0.05;
  EXPECT_NE(pads_unlike_grasp(kPads, block, beside).find("meet nothing of the part"), std::string::npos);
}

TEST(PadsUnlikeGrasp, AWedgeIsAsWideAsUnderTheWholePads) {
  // 2 cm wide in the hand's middle, and a quarter of the way wider on each side towards its thick end: at the pads'
  // ends, 2 cm from there, 3 cm.
  std::vector<Eigen::Vector3d> corners;
  for (const double z : {-0.05, 0.05})
    for (const double side : {-1.0, 1.0}) {
      corners.emplace_back(-0.02, side * 0.005, z);
      corners.emplace_back(0.03, side * 0.0175, z);
    }
  const std::vector<LinkShape> wedge{at(MeshShape{convex_hull(corners)})};
  EXPECT_EQ(unlike(wedge, 0.03), "");
  EXPECT_NE(unlike(wedge, 0.02).find("meet the part at 0.03"), std::string::npos) << unlike(wedge, 0.02);
}

TEST(PadsUnlikeGrasp, AWallBesideTheContactIsNotHeld) {
  // One leg of a U: the other stands inside the widest opening, and outside the one before the grasp or not.
  const auto u = [](double gap) {
    return std::vector<LinkShape>{at(Box{{0.1, 0.02, 0.1}}), at(Box{{0.1, 0.02, 0.1}}, 0, 0.02 + gap),
                                  at(Box{{0.1, 0.04 + gap, 0.02}}, 0, 0.01 + gap / 2, -0.06)};
  };
  EXPECT_EQ(unlike(u(0.011), 0.02), "");
  EXPECT_NE(unlike(u(0.009), 0.02), "");
}

}  // namespace
}  // namespace mmgrasp::verify
