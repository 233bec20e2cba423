#include <gtest/gtest.h>

#include "mmgrasp/collision/world.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/grasp/synthesize_grasps.hpp"
#include "support/planar_arm.hpp"

namespace mmgrasp {
namespace {

using Eigen::VectorXd;

/// Three links of half a metre, which turn by 0.6 rad either way at most.
const test::PlanarArm& arm() {
  static const test::PlanarArm arm(3, 0.5, 0.02, false, 0.6);
  return arm;
}

Rejection reached(const Pose& T, const World* world = nullptr) {
  const JointGroup group = arm().group();
  VectorXd q;
  const Rejection cause = make_arm_reach(group, VectorXd::Zero(3), world)(T, q);
  if (cause == Rejection::none) {
    EXPECT_LT((group.fk(q).matrix() - T.matrix()).norm(), 1e-3);
  }
  return cause;
}

}  // namespace

TEST(ArmReach, SaysWhatIsInTheWay) {
  const Pose T = arm().group().fk(Eigen::Vector3d(0.5, -0.4, 0.3));
  EXPECT_EQ(reached(T), Rejection::none);
  Pose far = T;
  far.translation().x() += 3;
  EXPECT_EQ(reached(far), Rejection::unreachable);
  World world;
  world.add("block", Box{{0.1, 0.1, 0.1}}, Pose(Eigen::Translation3d(T.translation())));
  EXPECT_EQ(reached(T, &world), Rejection::scene);
  EXPECT_EQ(reached(far, &world), Rejection::unreachable);
  World aside;
  aside.add("block", Box{{0.1, 0.1, 0.1}}, Pose(Eigen::Translation3d(0, 0, 1)));
  EXPECT_EQ(reached(T, &aside), Rejection::none);
  EXPECT_THROW(make_arm_reach(arm().group(), VectorXd::Zero(2)), InvalidInput);
}

TEST(ArmReach, SaysLimitsWhereOnlyTheyAreInTheWay) {
  const test::PlanarArm free(3, 0.5, 0.02, false, 2.8);
  EXPECT_EQ(reached(free.group().fk(Eigen::Vector3d(0, 1.2, 1.2))), Rejection::limits);
}

}  // namespace mmgrasp
