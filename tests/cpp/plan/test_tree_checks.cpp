#include "plan/manipulation/rrt_star_mg/tree_checks.hpp"

#include <gtest/gtest.h>

#include "support/tree_setting.hpp"

namespace mmgrasp::detail {
namespace {

TEST(TreeChecks, AnswersAreKeptForAllGraspsOfAnOpening) {
  test::TreeSetting setting(test::three_grasps());
  const auto configuration = [&](int grasp, int side) {
    return setting.trees.vertex(setting.root(grasp, side)).configuration;
  };
  const int a = configuration(0, GraspEnds::kStart), b = configuration(0, GraspEnds::kGoal);
  EXPECT_TRUE(setting.checks.edge_is_free(0, a, b));
  EXPECT_TRUE(setting.checks.edge_is_free(1, b, a));
  EXPECT_EQ(setting.stats.edges_checked_robot, 1u);
  EXPECT_EQ(setting.stats.edges_checked_attached, 2u);
}

TEST(TreeChecks, BlockedShortcutsAreNotCheckedAgain) {
  World world;
  world.add("wall", Shape(Box{{2.4, 0.02, 0.2}}), test::flat_pose(1.2, 0, 0));
  test::TreeSetting setting(test::three_grasps(), world);
  const int a = setting.trees.vertex(setting.root(0, GraspEnds::kStart)).configuration;
  const int b = setting.trees.vertex(setting.root(0, GraspEnds::kGoal)).configuration;
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(setting.checks.shortcut_is_free(0, a, b));
  EXPECT_EQ(setting.stats.edges_checked_attached, 1u);
  EXPECT_EQ(setting.checks.blocked_edge(0, {setting.root(0, GraspEnds::kStart), setting.root(0, GraspEnds::kGoal)}), 0);
}

}  // namespace
}  // namespace mmgrasp::detail
