// Motions between poses: what goes straight, what turns, and that looks are close enough.
#include "mmgrasp/grasp/detail/motion_looks.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mmgrasp/core/error.hpp"

namespace mmgrasp {
namespace {

Pose turned(double angle, const Eigen::Vector3d& axis, const Eigen::Vector3d& place) {
  Pose out = Pose::Identity();
  out.linear() = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
  out.translation() = place;
  return out;
}

TEST(MotionLooks, TheMiddleGoesStraightAndTheTurnIsEven) {
  const Pose from = turned(0.4, {1, 2, 3}, {0.3, -0.1, 0.2}), to = turned(2.3, {-1, 2, 1}, {0.1, 0.4, 0});
  const Eigen::Vector3d middle(0.5, -0.7, 0.2);
  const detail::MotionPiece piece(from, to, middle);
  EXPECT_NEAR(piece.way().norm(), (to * middle - from * middle).norm(), 1e-15);
  EXPECT_NEAR(piece.angle(), rotation_distance(from, to), 1e-12);
  for (const double share : {0.0, 0.25, 0.5, 0.9, 1.0}) {
    const Pose at = piece.at(share);
    const Eigen::Vector3d straight = (1 - share) * (from * middle) + share * (to * middle);
    EXPECT_LT((at * middle - straight).norm(), 1e-12) << share;
    EXPECT_NEAR(rotation_distance(from, at), share * piece.angle(), 1e-9) << share;
    EXPECT_NEAR(rotation_distance(at, to), (1 - share) * piece.angle(), 1e-9) << share;
  }
  EXPECT_EQ(piece.at(1).matrix(), to.matrix());
}

TEST(MotionLooks, LooksAreNoFartherApartThanAsked) {
  const Eigen::Vector3d middle(0.5, 0, 0);
  const Poses motion{turned(0, {0, 0, 1}, {0, 0, 0.1}), turned(1.5, {0, 0, 1}, {0, 0, 0.05}),
                     turned(1.5, {0, 0, 1}, {0, 0, 0})};
  const Poses looks = detail::motion_looks(motion, middle, 0.01, 0.05);
  for (std::size_t i = 1; i < looks.size(); ++i) {
    EXPECT_LE((looks[i] * middle - looks[i - 1] * middle).norm(), 0.01 + 1e-12);
    EXPECT_LE(rotation_distance(looks[i - 1], looks[i]), 0.05 + 1e-9);
  }
  EXPECT_EQ(looks.front().matrix(), motion.front().matrix());
  EXPECT_EQ(looks.back().matrix(), motion.back().matrix());
  EXPECT_THROW(detail::motion_looks(motion, middle, 1e-9, 0.05), InvalidInput);
}

TEST(MotionLooks, TheMiddleIsThatOfTheBoxAroundTheParts) {
  const auto tetrahedron = convex_hull({{0, 0, 0}, {0.1, 0, 0}, {0, 0.2, 0}, {0, 0, 0.4}});
  Pose aside = Pose::Identity();
  aside.translation() << 1, 0, 0;
  EXPECT_LT((detail::middle_of({{"a", tetrahedron}}) - Eigen::Vector3d(0.05, 0.1, 0.2)).norm(), 1e-15);
  EXPECT_LT(
      (detail::middle_of({{"a", tetrahedron}, {"b", tetrahedron, aside}}) - Eigen::Vector3d(0.55, 0.1, 0.2)).norm(),
      1e-15);
}

}  // namespace
}  // namespace mmgrasp
