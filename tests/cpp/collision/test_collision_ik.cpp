#include "mmgrasp/collision/collision_ik.hpp"

#include <gtest/gtest.h>

#include "mmgrasp/core/random.hpp"
#include "support/robot_support.hpp"

using namespace mmgrasp;
using testing_support::shared;

TEST(CollisionIk, SolutionsReachAndAreFree) {
  MMGRASP_NEEDS_SHARED_DATA();
  RobotOptions load;
  load.package_dirs["moveit_resources_panda_description"] = shared("robots/panda/moveit_resources_panda_description");
  const Robot robot = Robot::load(shared("robots/panda/expanded/panda.urdf"),
                                  shared("robots/panda/moveit_resources_panda_moveit_config/config/panda.srdf"), load);
  const JointGroup group = robot.group("panda_arm");
  World world;
  world.add("pillar", Cylinder{0.08, 1.5}, pose_from_xyz_rpy({0.35, 0.2, 0.6}, {0, 0, 0}));
  CollisionChecker checker(group, world);
  Rng rng(8);
  int solved = 0;
  for (int i = 0; i < 40; ++i) {
    Eigen::VectorXd q;
    do q = rng.uniform(group.lower(), group.upper());
    while (!checker.is_free(q));
    const Pose T = group.fk(q);
    // Seeded with a configuration in collision, the answer must still be free.
    const IkResult result = solve_collision_free_ik(checker, T, rng.uniform(group.lower(), group.upper()));
    if (result.outcome != Outcome::solved) continue;
    ++solved;
    EXPECT_LT(pose_difference(group.fk(result.q), T).norm(), 2e-4);
    EXPECT_EQ(CollisionChecker(group, world).rejection(result.q), Rejection::none);
  }
  EXPECT_GT(solved, 36);
}
