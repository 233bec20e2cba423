#include "plan/manipulation/rrt_star_mg/path_shortcutting.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/tree_setting.hpp"

namespace mmgrasp::detail {
namespace {

using test::TreeSetting;

class Shortcutting : public ::testing::Test {
 protected:
  explicit Shortcutting(World world = {}) : setting_(test::three_grasps(), std::move(world)) {
    int a = setting_.root(0, GraspEnds::kStart), b = setting_.root(0, GraspEnds::kGoal);
    for (const double share : {0.3, 0.6, 0.9}) {
      a = setting_.add(a, {-1 + share, share, 0.2});
      b = setting_.add(b, {1 - share, share, -0.2});
    }
    connections_.add(a, b);
    connections_.list_grasp(0);
    setting_.incumbent = {connections_.update(0).cost, 0};
  }

  PathShortcutting shortcutting() {
    return {setting_.trees, setting_.checks, connections_, setting_.incumbent, setting_.tuning};
  }

  TreeSetting setting_;
  TreeConnections connections_{setting_.trees};
};

TEST_F(Shortcutting, SkippingVerticesFindsAFreeStraightLine) {
  shortcutting().skip_vertices(0);
  EXPECT_NEAR(connections_.update(0).cost, 2, 1e-12);
  EXPECT_NO_THROW(setting_.trees.check_invariants());
}

TEST_F(Shortcutting, RandomShortcutsOnlyMakeThePathShorter) {
  PathShortcutting shortcutting = this->shortcutting();
  Rng rng(1);
  const double before = setting_.incumbent.cost;
  double last = before;
  int cuts = 0;
  for (int i = 0; i < 300; ++i) {
    const int grasp = shortcutting.improve_randomly(rng, 3);
    if (grasp < 0) continue;
    ASSERT_EQ(grasp, 0);
    ++cuts;
    const double cost = connections_.update(0).cost;
    EXPECT_LE(cost, last + 1e-9);
    last = setting_.incumbent.cost = std::min(last, cost);
  }
  EXPECT_GT(cuts, 10);
  EXPECT_GE(last, 2 - 1e-12);
  // Nothing is in the way: it ends at the straight line.
  EXPECT_LT(last, 2.001);
  EXPECT_NO_THROW(setting_.trees.check_invariants());
}

/// On an edge that bends nowhere vertices cost nothing, and would be drawn as corners again and again.
TEST_F(Shortcutting, SkippingVerticesLeavesNoneOnStraightLines) {
  const std::size_t corners = 3;
  ASSERT_NE(connections_.best(0).connection, -1);
  int a = setting_.root(1, GraspEnds::kStart);
  const Eigen::Vector3d from(-1.1, 0.3, 0), to(1.1, 0.3, 0);
  for (int i = 1; i < 20; ++i) a = setting_.add(a, from + (to - from) * (i / 20.0));
  connections_.add(a, setting_.root(1, GraspEnds::kGoal));
  connections_.list_grasp(1);
  connections_.update(1);
  shortcutting().skip_vertices(1);
  connections_.update(1);
  TreeConnections::Branches path;
  ASSERT_TRUE(connections_.trace_path(1, path));
  EXPECT_LE(path[0].size() + path[1].size(), corners);
  EXPECT_NEAR(connections_.best(1).cost, 2.2, 1e-12);
  EXPECT_NO_THROW(setting_.trees.check_invariants());
}

/// A post across the straight line.
class ShortcuttingAtAPost : public Shortcutting {
 protected:
  ShortcuttingAtAPost() : Shortcutting(post()) {}
  static World post() {
    World world;
    world.add("post", Shape(Box{{0.05, 0.02, 0.2}}), test::flat_pose(1.1, 0, 0));
    return world;
  }
};

TEST_F(ShortcuttingAtAPost, NoShortcutLeadsThroughIt) {
  PathShortcutting shortcutting = this->shortcutting();
  const double before = setting_.incumbent.cost;
  shortcutting.skip_vertices(0);
  connections_.update(0);
  Rng rng(2);
  for (int i = 0; i < 100; ++i)
    if (shortcutting.improve_randomly(rng, 3) >= 0) setting_.incumbent.cost = connections_.update(0).cost;
  EXPECT_LT(connections_.best(0).cost, before);
  EXPECT_GT(connections_.best(0).cost, 2 + 1e-3);
  EXPECT_NO_THROW(setting_.trees.check_invariants());
}

}  // namespace
}  // namespace mmgrasp::detail
