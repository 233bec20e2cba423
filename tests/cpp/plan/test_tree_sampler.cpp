#include "plan/manipulation/rrt_star_mg/tree_sampler.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "support/tree_setting.hpp"

namespace mmgrasp::detail {
namespace {

using test::TreeSetting;

TEST(TreeSampler, DrawsWhereTheGraspCanHaveABetterPath) {
  TreeSetting setting(test::three_grasps());
  TreeSampler sampler(setting.trees, setting.informed, setting.options, setting.tuning);
  setting.informed.set_cost(2.3);  // The third grasp's straight line is longer.
  Rng rng(1), again(1);
  TreeSetting twin(test::three_grasps());
  twin.informed.set_cost(2.3);
  TreeSampler other(twin.trees, twin.informed, twin.options, twin.tuning);
  int drawn[3] = {0, 0, 0};
  for (int i = 0; i < 2000; ++i) {
    const TreeSampler::Sample sample = sampler.draw(rng);
    ASSERT_GE(sample.grasp, 0);
    const Eigen::Map<const Eigen::Vector3d> q(setting.trees.configuration(sample.configuration));
    EXPECT_LT(setting.ends.estimate(sample.grasp, q.data()), 2.3);
    ++drawn[sample.grasp];
    const TreeSampler::Sample same = other.draw(again);
    EXPECT_EQ(same.grasp, sample.grasp);
    EXPECT_EQ(q, Eigen::Vector3d(Eigen::Map<const Eigen::Vector3d>(twin.trees.configuration(same.configuration))));
  }
  EXPECT_GT(drawn[0], drawn[1]);  // Its ellipsoid is the larger one.
  EXPECT_GT(drawn[1], 0);
  EXPECT_EQ(drawn[2], 0);
}

TEST(TreeSampler, WithoutInformedSetsDrawsWithinAllBounds) {
  TreeSetting setting(test::three_grasps());
  setting.options.informed = false;
  TreeSampler sampler(setting.trees, setting.informed, setting.options, setting.tuning);
  setting.informed.set_cost(2.05);
  Rng rng(2);
  int outside = 0;
  for (int i = 0; i < 500; ++i) {
    const TreeSampler::Sample sample = sampler.draw(rng);
    outside += setting.ends.estimate(0, setting.trees.configuration(sample.configuration)) > 2.05;
  }
  EXPECT_GT(outside, 450);
}

TEST(TreeSampler, PicksTheKthGraspWithAChanceThatFallsAsOneOverK) {
  std::vector<GraspCandidate> many;
  for (int g = 0; g < 20; ++g) many.push_back(TreeSetting::candidate(g, {-1, 0, 0}, {1, 0.01 * g, 0}));
  TreeSetting setting(many);
  const TreeSampler sampler(setting.trees, setting.informed, setting.options, setting.tuning);
  Rng rng(3);
  constexpr int kDraws = 200000;
  std::vector<int> counts(20, 0);
  for (int i = 0; i < kDraws; ++i) {
    const int grasp = sampler.pick_grasp(rng);
    ASSERT_GE(grasp, 0);
    ASSERT_LT(grasp, 20);
    ++counts[grasp];
  }
  for (int k = 1; k <= 20; ++k) {
    // floor(21^u) = k has this chance: about 1 / k by log 21.
    const double expected = std::log((k + 1.0) / k) / std::log(21.0);
    EXPECT_NEAR(counts[k - 1], kDraws * expected, 5 * std::sqrt(kDraws * expected)) << k;
  }
}

TEST(TreeSampler, NearStraightLinesMeansOnShortDetours) {
  TreeSetting setting(test::three_grasps());
  setting.tuning.near_line_probability = 1;
  TreeSampler sampler(setting.trees, setting.informed, setting.options, setting.tuning);
  Rng rng(4);
  // 0.1 rad are added to every detour.
  const double longest = 2 * (setting.tuning.min_detour + setting.tuning.detour_range) + 0.1 + 1e-9;
  int short_ones = 0;
  for (int i = 0; i < 2000; ++i) {
    const double* q = setting.trees.configuration(sampler.draw_near_straight_line(rng, 0));
    EXPECT_LT(setting.ends.estimate(0, q), longest);
    short_ones += setting.ends.estimate(0, q) < 2 * 0.5 * (setting.tuning.min_detour + longest / 2);
  }
  EXPECT_GT(short_ones, 1200);
}

TEST(TreeSampler, ReassignsToGraspsThatMayImproveAndLackTheConfiguration) {
  TreeSetting setting(test::three_grasps());
  TreeSampler sampler(setting.trees, setting.informed, setting.options, setting.tuning);
  setting.informed.set_cost(2.3);
  const Eigen::Vector3d useful(0, 0.15, 0), useless(0, 2.5, 0);
  const int in_first = setting.add(setting.root(0, GraspEnds::kStart), useful);
  const int configuration = setting.trees.vertex(in_first).configuration;
  Rng rng(5);
  for (int i = 0; i < 20; ++i) {
    sampler.reassign(configuration);
    sampler.reassign(setting.trees.add_configuration(useless.data()));
    const TreeSampler::Sample sample = sampler.draw_reassigned(rng, GraspEnds::kStart);
    EXPECT_EQ(sample.configuration, configuration);
    EXPECT_EQ(sample.grasp, 1);  // The first one has it, the third one cannot win.
    EXPECT_LT(sampler.draw_reassigned(rng, GraspEnds::kStart).configuration, 0);
  }
}

}  // namespace
}  // namespace mmgrasp::detail
