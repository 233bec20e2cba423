#include "plan/manipulation/prm_star_mg/transfer_refinement.hpp"

#include <gtest/gtest.h>

#include "mmgrasp/core/error.hpp"
#include "support/bar_transfer.hpp"
#include "support/fcl_transfer.hpp"

namespace mmgrasp {
namespace {

ManipulationOptions with_refinements(int count, unsigned seed = 1) {
  ManipulationOptions options;
  options.prm.roadmap.vertices = 300;
  options.prm.refinements = count;
  options.ik_solutions = 2;
  options.time_limit = 100;
  options.seed = seed;
  return options;
}

TEST(TransferRefinement, RoundsOnlyMakeItCheaperAndFclFindsItFree) {
  const ManipulationProblem problem = test::bar_transfer();
  int gained = 0;
  for (unsigned seed = 1; seed <= 4; ++seed) {
    const ManipulationResult none = plan_manipulation(problem, with_refinements(0, seed));
    ASSERT_EQ(none.outcome, Outcome::solved);
    double last = none.cost;
    for (const int count : {1, 8, 64}) {
      const ManipulationResult result = plan_manipulation(problem, with_refinements(count, seed));
      ASSERT_TRUE(result.path);
      // More rounds begin with those of fewer.
      EXPECT_LE(result.cost, last) << count;
      EXPECT_NEAR(result.cost, result.path->length(), 1e-9);
      EXPECT_TRUE(test::FclTransfer(problem, result.grasp_index, 0.4, 0.02).is_free(*result.path, 0.005));
      for (std::size_t i = 1; i < result.improvements.size(); ++i)
        EXPECT_LT(result.improvements[i].cost, result.improvements[i - 1].cost);
      // What is known of the roadmap before stays known, and no more.
      EXPECT_EQ(result.stats.roadmap_bound, std::min(none.stats.roadmap_bound, result.cost));
      EXPECT_EQ(result.stats.roadmap_cost, none.stats.roadmap_cost);
      last = result.cost;
    }
    gained += last < 0.99 * none.cost ? 1 : 0;
  }
  EXPECT_GT(gained, 0);
}

TEST(TransferRefinement, SameAnswerAtAnyNumberOfThreads) {
  const ManipulationProblem problem = test::bar_transfer();
  ManipulationOptions options = with_refinements(40);
  options.threads = 1;
  const ManipulationResult expected = plan_manipulation(problem, options);
  ASSERT_TRUE(expected.path);
  for (const int threads : {2, 3}) {
    options.threads = threads;
    const ManipulationResult result = plan_manipulation(problem, options);
    ASSERT_TRUE(result.path);
    EXPECT_EQ(result.path->waypoints, expected.path->waypoints);
    EXPECT_EQ(result.improvements.size(), expected.improvements.size());
    EXPECT_EQ(result.stats.graph_searches, expected.stats.graph_searches);
  }
}

TEST(TransferRefinement, EndsWhereNoGraspCanWin) {
  ManipulationProblem problem = test::bar_transfer();
  problem.world = World{};
  problem.T_world_goal = test::flat_pose(0.6, 0.3, 0.9);
  const ManipulationResult result = plan_manipulation(problem, with_refinements(1'000'000'000));
  ASSERT_EQ(result.outcome, Outcome::solved);
  EXPECT_EQ(result.path->waypoints.size(), 2u);
  EXPECT_EQ(result.cost, result.stats.postures_bound);
}

TEST(TransferRefinement, StopsWithWhatItHas) {
  const ManipulationProblem problem = test::bar_transfer();
  const double before = plan_manipulation(problem, with_refinements(0)).cost;
  Monitor monitor;
  const ManipulationResult result =
      plan_manipulation(problem, with_refinements(1'000'000'000), nullptr, monitor, [&](const Improvement& better) {
        if (better.cost < before) monitor.stop.stop();  // The first of the rounds' own.
      });
  ASSERT_EQ(result.outcome, Outcome::solved);
  EXPECT_LT(result.cost, before);
}

TEST(TransferRefinement, RefusesFewerThanNone) {
  EXPECT_THROW(plan_manipulation(test::bar_transfer(), with_refinements(-1)), InvalidInput);
}

}  // namespace
}  // namespace mmgrasp
