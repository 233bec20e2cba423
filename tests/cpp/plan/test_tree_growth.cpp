#include "plan/manipulation/rrt_star_mg/tree_growth.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/detail/numbers.hpp"
#include "support/tree_setting.hpp"

namespace mmgrasp::detail {
namespace {

using test::TreeSetting;

class Growing : public ::testing::Test {
 protected:
  explicit Growing(World world = {}) : setting_(test::three_grasps(), std::move(world)) {
    setting_.options.range = 0.5;
    setting_.options.gamma = 1000;  // All within a step are near.
  }

  Eigen::Vector3d draw() { return rng_.uniform(Eigen::Vector3d::Constant(-2), Eigen::Vector3d::Constant(2)); }
  int add(const Eigen::Vector3d& q) { return setting_.trees.add_configuration(q.data()); }
  double apart(int a, int b) const { return setting_.trees.vertex_distance(a, b); }

  TreeSetting setting_;
  GraspTrees& trees_ = setting_.trees;
  Rng rng_{7};
  TreeGrowth growth_{trees_, setting_.checks, setting_.near, setting_.incumbent, setting_.options, setting_.tuning};
};

/// Independent of the near-vertex search: all vertices of the tree are compared.
TEST_F(Growing, TakesTheCheapestParentWithinAStepAndRewiresTheRest) {
  const int tree = GraspTrees::tree(0, GraspEnds::kStart);
  int rewirings = 0;
  growth_.on_rewired = [&](int grasp) {
    EXPECT_EQ(grasp, 0);
    ++rewirings;
  };
  for (int i = 0; i < 600; ++i) {
    const int made = growth_.extend_tree(tree, add(draw()));
    ASSERT_GE(made, 0);
    const GraspTrees::Vertex& vertex = trees_.vertex(made);
    EXPECT_LE(apart(made, vertex.parent), 0.5 + 1e-9);
    double cheapest = kInfinity;
    for (int v = 0; v < made; ++v)
      if (trees_.vertex(v).tree == tree && apart(v, made) < 0.5 - 1e-9)
        cheapest = std::min(cheapest, trees_.vertex(v).cost + apart(v, made));
    EXPECT_LE(vertex.cost, cheapest + 1e-9);
    for (int v = 0; v < made; ++v) {
      if (trees_.vertex(v).tree != tree || apart(v, made) >= 0.5 - 1e-9) continue;
      EXPECT_LE(trees_.vertex(v).cost, vertex.cost + apart(v, made) + 1e-8);
    }
  }
  EXPECT_GT(rewirings, 20);
  EXPECT_NO_THROW(trees_.check_invariants());
}

TEST_F(Growing, ExploitationTakesTheTreeWithTheLeastCostToComeAndToGo) {
  const Eigen::Vector3d q(-0.9, 0.2, 0);
  const TreeGrowth::Extension made = growth_.extend_cheapest_tree(GraspEnds::kStart, add(q));
  ASSERT_GE(made.vertex, 0);
  double least = kInfinity;
  int expected = -1;
  for (int grasp = 0; grasp < 3; ++grasp) {
    const double cost = setting_.ends.distance(grasp, GraspEnds::kStart, q.data()) +
                        setting_.ends.distance(grasp, GraspEnds::kGoal, q.data());
    if (cost < least) expected = grasp;
    least = std::min(least, cost);
  }
  EXPECT_EQ(GraspTrees::grasp_of(trees_.vertex(made.vertex).tree), expected);
}

TEST_F(Growing, WhatCannotBeatTheIncumbentIsPruned) {
  setting_.incumbent = {2.5, 0};
  EXPECT_TRUE(growth_.extend_cheapest_tree(GraspEnds::kStart, add({-1, 1.5, 0})).pruned);
  EXPECT_LT(growth_.extend_tree(GraspTrees::tree(0, GraspEnds::kStart), add({-1, 1.5, 0})), 0);
  EXPECT_FALSE(growth_.extend_cheapest_tree(GraspEnds::kStart, add({-0.8, 0, 0})).pruned);
}

TEST_F(Growing, TakesOverSomeConfigurationsOfOtherTreesNearby) {
  setting_.incumbent = {4, 0};
  const int other = setting_.root(1, GraspEnds::kStart);
  for (int i = 0; i < 8; ++i) setting_.add(other, {-0.9 + 0.01 * i, 0.28, 0});
  const int before = trees_.tree_size(GraspTrees::tree(0, GraspEnds::kStart));
  const TreeGrowth::Extension made = growth_.extend_cheapest_tree(GraspEnds::kStart, add({-0.8, 0, 0}));
  ASSERT_GE(made.vertex, 0);
  ASSERT_EQ(GraspTrees::grasp_of(trees_.vertex(made.vertex).tree), 0);
  EXPECT_EQ(trees_.tree_size(GraspTrees::tree(0, GraspEnds::kStart)), before + 1 + setting_.tuning.max_duplicates);
  EXPECT_NO_THROW(trees_.check_invariants());
}

/// A wall across the straight line of the first grasp.
class GrowingAtAWall : public Growing {
 protected:
  GrowingAtAWall() : Growing(wall()) {}
  /// `inset`: less on every side.
  static World wall(double inset = 0) {
    World world;
    const Eigen::Vector3d size = Eigen::Vector3d(0.2, 0.02, 0.2) - Eigen::Vector3d::Constant(2 * inset);
    world.add("wall", Shape(Box{size}), test::flat_pose(1.1, 0, 0));
    return world;
  }
};

TEST_F(GrowingAtAWall, HalfOfABlockedEdgeIsAddedWhenItIsFree) {
  const int root = setting_.root(0, GraspEnds::kStart);
  const Eigen::Vector3d beyond(0.5, 0, 0);
  const int half = growth_.extend_half(root, add(beyond));
  ASSERT_GE(half, 0);
  EXPECT_NEAR(trees_.vertex(half).cost, 0.75, 1e-12);
  EXPECT_NEAR(trees_.at(half)[0], -0.25, 1e-12);
  EXPECT_LT(growth_.extend_half(half, add({0.25, 0, 0})), 0);  // That half ends in the wall.
}

TEST_F(GrowingAtAWall, NoVertexIsAddedAcrossIt) {
  for (int i = 0; i < 300; ++i) growth_.extend_tree(GraspTrees::tree(0, GraspEnds::kStart), add(draw()));
  // Between two checks points move 5 mm, so that an edge may enter by half of that.
  ManipulationProblem smaller = setting_.problem;
  smaller.world = wall(0.0026);
  CollisionChecker checker(smaller.group, test::carrying(smaller, smaller.grasps[0]));
  trees_.each_in_tree(GraspTrees::tree(0, GraspEnds::kStart), [&](int v) {
    const int parent = trees_.vertex(v).parent;
    if (parent < 0) return;
    const Eigen::Map<const Eigen::Vector3d> a(trees_.at(parent)), b(trees_.at(v));
    EXPECT_TRUE(checker.edge_is_free(a, b, 0.02));
  });
}

}  // namespace
}  // namespace mmgrasp::detail
