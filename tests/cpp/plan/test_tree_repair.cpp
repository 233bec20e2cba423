#include "plan/manipulation/rrt_star_mg/tree_repair.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "plan/manipulation/rrt_star_mg/tree_sampler.hpp"
#include "support/tree_setting.hpp"

namespace mmgrasp::detail {
namespace {

using test::TreeSetting;

/// The stretched arm meets a post; bent by more than a radian it passes. All edges are put into the tree unchecked.
class Repair : public ::testing::Test {
 protected:
  static World post() {
    World world;
    world.add("post", Shape(Box{{0.05, 0.02, 0.2}}), test::flat_pose(1.1, 0, 0));
    return world;
  }
  bool verified(int a, int b) {
    return setting_.checks.edge_is_verified(0, setting_.trees.vertex(a).configuration,
                                            setting_.trees.vertex(b).configuration);
  }
  int parent(int v) const { return setting_.trees.vertex(v).parent; }

  TreeSetting setting_{test::three_grasps(), post()};
  TreeSampler sampler_{setting_.trees, setting_.informed, setting_.options, setting_.tuning};
  TreeRepair repair_{setting_.trees, setting_.checks, setting_.near, sampler_};
  int root_ = setting_.root(0, GraspEnds::kStart);
};

TEST_F(Repair, HangsAVertexAndAllBelowItElsewhere) {
  const int bent = setting_.add(root_, {-0.5, 1.6, 0}), past = setting_.add(bent, {0.5, 1.6, 0});
  const int cut = setting_.add(root_, {0.5, 0.4, 0}), below = setting_.add(cut, {0.8, 0.2, 0});
  ASSERT_FALSE(verified(root_, cut));
  ASSERT_TRUE(verified(past, cut));
  repair_.reconnect(cut);
  EXPECT_EQ(parent(cut), past);
  EXPECT_EQ(parent(below), cut);
  EXPECT_NO_THROW(setting_.trees.check_invariants());
}

TEST_F(Repair, TurnsABranchWhoseEndAloneHasAnotherWay) {
  setting_.options.range = 3;  // The way round the post is long.
  const int bent = setting_.add(root_, {-1.5, 2, 0});
  const int cut = setting_.add(root_, {0.7, 0, 0});
  const int middle = setting_.add(cut, {0.8, 0.1, 0}), side = setting_.add(cut, {1.2, 0, 0});
  const int end = setting_.add(middle, {0.3, 2, 0});
  ASSERT_FALSE(verified(root_, cut));
  for (const int v : {cut, middle, side}) {
    ASSERT_FALSE(verified(root_, v));
    ASSERT_FALSE(verified(bent, v));
  }
  ASSERT_TRUE(verified(bent, end));
  repair_.reconnect(cut);
  EXPECT_EQ(parent(end), bent);
  EXPECT_EQ(parent(middle), end);
  EXPECT_EQ(parent(cut), middle);
  EXPECT_EQ(parent(side), cut);
  EXPECT_NO_THROW(setting_.trees.check_invariants());
}

TEST_F(Repair, OffersWhatHasNoOtherWayToOtherGrasps) {
  const int cut = setting_.add(root_, {0.5, 0, 0}), below = setting_.add(cut, {0.9, 0, 0});
  const int configuration = setting_.trees.vertex(below).configuration;
  ASSERT_FALSE(verified(root_, cut));
  ASSERT_FALSE(verified(root_, below));
  repair_.reconnect(cut);
  EXPECT_EQ(setting_.trees.tree_size(GraspTrees::tree(0, GraspEnds::kStart)), 1);
  EXPECT_NO_THROW(setting_.trees.check_invariants());
  Rng rng(1);
  std::vector<int> offered;
  for (;;) {
    const TreeSampler::Sample sample = sampler_.draw_reassigned(rng, GraspEnds::kStart);
    if (sample.configuration < 0) break;
    offered.push_back(sample.configuration);
  }
  EXPECT_EQ(offered.size(), 2u);
  EXPECT_NE(std::find(offered.begin(), offered.end(), configuration), offered.end());
}

TEST_F(Repair, ARefusedEdgeIsBlockedFromThenOn) {
  const int cut = setting_.add(root_, {0.5, 0, 0});
  ASSERT_EQ(setting_.checks.blocked_edge(0, {root_, cut}), 0);
  const std::size_t before = setting_.stats.edges_checked_attached;
  EXPECT_FALSE(setting_.checks.edge_is_free(0, setting_.trees.vertex(root_).configuration,
                                            setting_.trees.vertex(cut).configuration));
  EXPECT_EQ(setting_.stats.edges_checked_attached, before);
}

}  // namespace
}  // namespace mmgrasp::detail
