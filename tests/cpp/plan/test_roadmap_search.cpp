#include "plan/manipulation/prm_star_mg/roadmap_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "support/bar_transfer.hpp"

namespace mmgrasp {
namespace {

/// All grasps are searched before any path is checked, as in the paper.
ManipulationOptions as_in_the_paper() {
  ManipulationOptions options;
  options.first_grasps = 0;
  options.straight = false;
  options.ik_solutions = 2;
  options.time_limit = 100;
  options.threads = 1;
  options.prm.lazy_grasps = false;
  options.prm.shorten = false;
  return options;
}

/// Twenty grasps in an empty world: nothing blocks the robot, and grasps share bounds alone.
class SharedBounds : public ::testing::Test {
 protected:
  SharedBounds() { problem_.world = World{}; }

  static Roadmap roadmap() {
    RoadmapOptions options;
    options.vertices = 300;
    options.gamma = 5;
    return Roadmap::build(test::bar_transfer().group, options);
  }

  /// One grasp alone, with the arm configurations that it has among the others.
  ManipulationResult alone(std::size_t grasp) const {
    ManipulationProblem problem = problem_;
    problem.grasps = {problem_.grasps[grasp]};
    ManipulationOptions options = as_in_the_paper();
    options.ik.seed += static_cast<unsigned>(grasp);
    return plan_manipulation(problem, options, &roadmap_);
  }

  ManipulationProblem problem_ = test::bar_transfer();
  const Roadmap roadmap_ = roadmap();
};

TEST_F(SharedBounds, PathsOfEarlierGraspsKeepSearchesSmall) {
  std::size_t searches = 0, opened = 0;
  double cheapest = std::numeric_limits<double>::infinity();
  for (std::size_t grasp = 0; grasp < problem_.grasps.size(); ++grasp) {
    const ManipulationResult result = alone(grasp);
    searches += result.stats.graph_searches;
    opened += result.stats.nodes_opened;
    if (result.path) cheapest = std::min(cheapest, result.cost);
  }
  ASSERT_GE(searches, 8u);
  const ManipulationResult together = plan_manipulation(problem_, as_in_the_paper(), &roadmap_);
  ASSERT_EQ(together.outcome, Outcome::solved);
  EXPECT_NEAR(together.cost, cheapest, 1e-12);
  EXPECT_EQ(together.stats.graph_searches, searches);
  // Without any bound it would be as many: each of these searches is done before there is a best path.
  EXPECT_LT(static_cast<double>(together.stats.nodes_opened), 0.6 * static_cast<double>(opened));
  EXPECT_GT(together.stats.nodes_opened, 0u);
}

TEST_F(SharedBounds, NothingIsOpenedBeforeChecksWhenGraspsAreSearchedLazily) {
  ManipulationOptions options = as_in_the_paper();
  options.prm.lazy_grasps = true;
  const ManipulationResult lazy = plan_manipulation(problem_, options, &roadmap_);
  EXPECT_EQ(lazy.outcome, Outcome::solved);
  EXPECT_EQ(lazy.stats.nodes_opened, 0u);
}

}  // namespace
}  // namespace mmgrasp
