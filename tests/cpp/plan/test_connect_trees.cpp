#include "plan/manipulation/rrt_star_mg/connect_trees.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/tree_setting.hpp"

namespace mmgrasp::detail {
namespace {

using test::TreeSetting;

TEST(ConnectTrees, TakesTheCheapestEdgeToTheOtherTree) {
  TreeSetting setting(test::three_grasps());
  TreeConnections connections(setting.trees);
  setting.options.range = 5;
  setting.options.gamma = 1000;
  ConnectTrees connect(setting.trees, setting.checks, setting.near, setting.incumbent, connections, setting.options,
                       setting.tuning);
  const int detour = setting.add(setting.root(0, GraspEnds::kGoal), {0.5, 1, 0});
  const int made = setting.add(setting.root(0, GraspEnds::kStart), {0.4, 0.9, 0});
  ASSERT_LT(setting.trees.vertex_distance(made, detour), 0.2);  // The nearest one is not the cheapest.
  EXPECT_TRUE(connect.connect(made).connected);
  const TreeConnections::BestPath best = connections.update(0);
  EXPECT_EQ(connections.connection(best.connection).goal_vertex, setting.root(0, GraspEnds::kGoal));
  EXPECT_NEAR(best.cost, std::hypot(1.4, 0.9) + std::hypot(0.6, 0.9), 1e-12);
  // A path that is not better is none.
  EXPECT_FALSE(connect.connect(made).connected);
  setting.incumbent = {1, 1};
  EXPECT_FALSE(connect.connect(setting.add(made, {0.8, 0.1, 0})).connected);
}

TEST(ConnectTrees, NamesTheNearestVertexWhenEveryEdgeIsBlocked) {
  World world;
  world.add("wall", Shape(Box{{2.4, 0.02, 0.2}}), test::flat_pose(1.2, 0, 0));
  TreeSetting setting(test::three_grasps(), world);
  TreeConnections connections(setting.trees);
  ConnectTrees connect(setting.trees, setting.checks, setting.near, setting.incumbent, connections, setting.options,
                       setting.tuning);
  const ConnectTrees::Attempt attempt = connect.connect(setting.root(0, GraspEnds::kStart));
  EXPECT_FALSE(attempt.connected);
  EXPECT_EQ(attempt.blocked_vertex, setting.root(0, GraspEnds::kGoal));
}

}  // namespace
}  // namespace mmgrasp::detail
