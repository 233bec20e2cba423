#include "plan/manipulation/rrt_star_mg/tree_pruning.hpp"

#include <gtest/gtest.h>

#include <set>

#include "plan/manipulation/rrt_star_mg/tree_growth.hpp"
#include "support/tree_setting.hpp"

namespace mmgrasp::detail {
namespace {

TEST(TreePruning, LeavesOnlyWhatCanBeBetterAndReassignsTheRest) {
  test::TreeSetting setting(test::three_grasps());
  GraspTrees& trees = setting.trees;
  TreeSampler sampler(trees, setting.informed, setting.options, setting.tuning);
  TreeGrowth growth(trees, setting.checks, setting.near, setting.incumbent, setting.options, setting.tuning);
  Rng rng(1);
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d q = rng.uniform(Eigen::Vector3d::Constant(-2), Eigen::Vector3d::Constant(2));
    growth.extend_tree(i % 6, trees.add_configuration(q.data()));
  }
  setting.incumbent = {2.3, 0};
  prune_and_reassign(setting.incumbent, trees, setting.informed, sampler);
  EXPECT_NO_THROW(trees.check_invariants());
  for (const int side : {GraspEnds::kStart, GraspEnds::kGoal})
    EXPECT_EQ(trees.tree_size(GraspTrees::tree(2, side)), 0);  // Its straight line costs 2.4.
  std::set<int> kept;
  for (int v = 0; v < trees.vertex_count(); ++v) {
    const GraspTrees::Vertex& vertex = trees.vertex(v);
    if (!vertex.alive) continue;
    kept.insert(vertex.configuration);
    if (vertex.parent >= 0 && vertex.first_child < 0) {
      EXPECT_LE(vertex.estimate, 2.3 + 1e-6);
    }
  }
  EXPECT_LT(kept.size(), 300u);
  // What is offered again serves another grasp and is in no tree.
  int offered = 0;
  for (;;) {
    const TreeSampler::Sample sample = sampler.draw_reassigned(rng, GraspEnds::kStart);
    if (sample.configuration < 0) break;
    ++offered;
    EXPECT_EQ(kept.count(sample.configuration), 0u);
    EXPECT_TRUE(setting.informed.contains(sample.grasp, trees.configuration(sample.configuration)));
  }
  EXPECT_GT(offered, 0);
}

}  // namespace
}  // namespace mmgrasp::detail
