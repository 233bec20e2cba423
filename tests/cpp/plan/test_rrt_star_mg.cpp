#include "mmgrasp/plan/rrt_star_mg.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

#include "mmgrasp/core/error.hpp"
#include "support/bar_transfer.hpp"

namespace mmgrasp {
namespace {

using test::bar_transfer;
using test::flat_pose;

ManipulationOptions tree_options(int samples = 1000) {
  ManipulationOptions options;
  options.planner = "rrt_star_mg";
  options.rrt.max_iterations = samples;
  options.ik_solutions = 2;
  options.time_limit = 100;
  return options;
}

void expect_sound(const ManipulationProblem& problem, const ManipulationResult& result) {
  ASSERT_EQ(result.outcome, Outcome::solved);
  const Grasp& grasp = problem.grasps[result.grasp_index];
  CollisionChecker checker(problem.group, test::carrying(problem, grasp));
  const auto& waypoints = result.path->waypoints;
  for (std::size_t i = 0; i + 1 < waypoints.size(); ++i)
    EXPECT_TRUE(checker.edge_is_free(waypoints[i], waypoints[i + 1], 0.005));
  const auto object_at = [&](const Eigen::VectorXd& q) { return problem.group.fk(q) * grasp.T_object_hand.inverse(); };
  EXPECT_LT((object_at(waypoints.front()).matrix() - problem.T_world_start.matrix()).norm(), 3e-4);
  EXPECT_LT((object_at(waypoints.back()).matrix() - problem.T_world_goal.matrix()).norm(), 3e-4);
  EXPECT_NEAR(result.cost, result.path->length() + grasp.cost, 1e-9);
  EXPECT_GE(result.cost, result.lower_bound - 1e-9);
}

TEST(RrtStarMg, MovesTheObjectOnFreePaths) {
  const ManipulationProblem problem = bar_transfer();
  for (unsigned seed = 1; seed <= 10; ++seed) {
    ManipulationOptions options = tree_options(500);
    options.seed = seed;
    double last = std::numeric_limits<double>::infinity();
    int reported = 0;
    const ManipulationResult result = plan_manipulation(problem, options, nullptr, {}, [&](const Improvement& better) {
      EXPECT_LT(better.cost, last);
      last = better.cost;
      ++reported;
    });
    expect_sound(problem, result);
    EXPECT_EQ(result.cost, last);
    EXPECT_EQ(result.improvements.size(), reported);
    EXPECT_LE(result.stats.samples, 500u);
  }
}

TEST(RrtStarMg, EverySwitchLeavesPathsSound) {
  const ManipulationProblem problem = bar_transfer();
  for (const bool bidirectional : {true, false})
    for (const bool informed : {true, false})
      for (const double exploration : {0.0, 0.5, 1.0}) {
        ManipulationOptions options = tree_options(1500);
        options.rrt.bidirectional = bidirectional;
        options.rrt.informed = informed;
        options.rrt.exploration = exploration;
        expect_sound(problem, plan_manipulation(problem, options));
      }
}

constexpr unsigned kRuns = 10;

/// Where the trees of a few runs grew.
struct Growth {
  double all = 0, from_goals = 0;
  double outside = 0;  ///< Where no path through the vertex is cheaper than the one found.
  double cost = 0;     ///< Mean.
};

double nearest_root(const std::vector<SearchTree>& trees, int grasp, bool from_goal, const Eigen::VectorXd& q) {
  double least = std::numeric_limits<double>::infinity();
  for (const SearchTree& tree : trees) {
    if (tree.grasp != grasp || tree.from_goal != from_goal) continue;
    for (std::size_t i = 0; i < tree.parents.size(); ++i)
      if (tree.parents[i] < 0) least = std::min(least, (tree.vertices.col(static_cast<Eigen::Index>(i)) - q).norm());
  }
  return least;
}

Growth growth_with(const std::function<void(RrtStarMgOptions&)>& change) {
  const ManipulationProblem problem = bar_transfer();
  Growth out;
  for (unsigned seed = 1; seed <= kRuns; ++seed) {
    ManipulationOptions options = tree_options(1500);
    options.seed = seed;
    options.rrt.keep_trees = true;
    change(options.rrt);
    const ManipulationResult result = plan_manipulation(problem, options);
    EXPECT_EQ(result.stats.samples, 1500u);
    out.cost += result.cost / kRuns;
    for (const SearchTree& tree : result.trees)
      for (std::size_t i = 0; i < tree.parents.size(); ++i) {
        if (tree.parents[i] < 0) continue;
        const Eigen::VectorXd q = tree.vertices.col(static_cast<Eigen::Index>(i));
        const double through =
            nearest_root(result.trees, tree.grasp, false, q) + nearest_root(result.trees, tree.grasp, true, q);
        out.all += 1;
        out.from_goals += tree.from_goal;
        out.outside += through >= result.cost;
      }
  }
  EXPECT_GT(out.all, 500);
  return out;
}

TEST(RrtStarMg, WithoutBidirectionalTreesGrowFromTheStartsAlone) {
  EXPECT_EQ(growth_with([](RrtStarMgOptions& o) { o.bidirectional = false; }).from_goals, 0);
  EXPECT_GT(growth_with([](RrtStarMgOptions&) {}).from_goals, 300);
}

TEST(RrtStarMg, InformedTreesGrowWhereABetterPathCanPass) {
  const Growth informed = growth_with([](RrtStarMgOptions& o) { o.exploration = 1; });
  const Growth anywhere = growth_with([](RrtStarMgOptions& o) {
    o.exploration = 1;
    o.informed = false;
  });
  EXPECT_LT(informed.outside, 0.2 * informed.all);
  // Trees drop what cannot lie on a cheaper path, so this share depends on how soon paths get short.
  EXPECT_GT(anywhere.outside / anywhere.all, 2 * informed.outside / informed.all);
  EXPECT_LT(informed.cost, anywhere.cost);
}

/// Each grasp is in the list once more at a higher cost. By (5.1) alone the costlier trees look worse wherever the
/// others have grown; exploring hands them the samples of their own ellipsoids.
TEST(RrtStarMg, ExplorationGrowsTreesThatLookCostlier) {
  ManipulationProblem problem = bar_transfer();
  problem.world.add("wall", Shape(Box{{0.04, 0.3, 0.2}}), flat_pose(0.62, 0.02, 0.3));
  const int count = static_cast<int>(problem.grasps.size());
  for (int g = 0; g < count; ++g) {
    problem.grasps.push_back(problem.grasps[g]);
    problem.grasps.back().cost += 0.2;
  }
  const auto share_of_dearer = [&](double exploration) {
    ManipulationOptions options = tree_options(1500);
    options.rrt.keep_trees = true;
    options.rrt.exploration = exploration;
    double costlier = 0, all = 0;
    for (unsigned seed = 1; seed <= 3; ++seed) {
      options.seed = seed;
      for (const SearchTree& tree : plan_manipulation(problem, options).trees)
        for (const int parent : tree.parents) {
          all += parent >= 0;
          costlier += parent >= 0 && tree.grasp >= count;
        }
    }
    EXPECT_GT(all, 1000);
    return costlier / all;
  };
  const double exploiting = share_of_dearer(0), exploring = share_of_dearer(1);
  EXPECT_GT(exploring, 4 * exploiting + 0.03);
}

/// P2 Algorithm 5.13, line 13.
TEST(RrtStarMg, ExplorationBeginsWithAPath) {
  ManipulationProblem problem = bar_transfer();
  problem.world.add("wall", Shape(Box{{1.3, 0.02, 0.2}}), flat_pose(0.75, 0, 0));
  std::vector<ManipulationStats> stats;
  for (const double exploration : {0.0, 1.0}) {
    ManipulationOptions options = tree_options(600);
    options.rrt.exploration = exploration;
    const ManipulationResult result = plan_manipulation(problem, options);
    ASSERT_FALSE(result.path);
    stats.push_back(result.stats);
  }
  EXPECT_GT(stats[0].vertices, 600u);
  EXPECT_EQ(stats[0].vertices, stats[1].vertices);
  EXPECT_EQ(stats[0].edges_checked_robot, stats[1].edges_checked_robot);
  EXPECT_EQ(stats[0].edges_checked_attached, stats[1].edges_checked_attached);
}

/// Errata on Algorithm 5.13, line 17: the print would end with the first sample that no tree can use.
TEST(RrtStarMg, SamplesThatServeNoTreeDoNotEndTheSearch) {
  ManipulationOptions options = tree_options(3000);
  options.rrt.exploration = 0;
  options.rrt.informed = false;  // Most of the box is of no use once there is a path.
  const ManipulationResult result = plan_manipulation(bar_transfer(), options);
  ASSERT_EQ(result.outcome, Outcome::solved);
  EXPECT_EQ(result.stats.samples, 3000u);
  // One that serves a tree adds a vertex or more: a third of them did not.
  EXPECT_LT(result.stats.vertices, 2000u);
}

/// Errata on Algorithm 5.13, lines 14 and 20: as printed, nothing would be joined to what exploring adds, and most runs
/// would stay with the grasp that was quickest.
TEST(RrtStarMg, ExploringAloneJoinsTheTreesOfOtherGrasps) {
  std::vector<double> costs;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    ManipulationOptions options = tree_options(1500);
    options.seed = seed;
    options.rrt.exploration = 1;
    const ManipulationResult result = plan_manipulation(bar_transfer(), options);
    expect_sound(bar_transfer(), result);
    costs.push_back(result.cost);
  }
  const auto [least, most] = std::minmax_element(costs.begin(), costs.end());
  EXPECT_LT(*most, 1.03 * *least);
}

/// What is handed over must be trees: whole, of free edges, rooted in the grasp's own arm configurations.
TEST(RrtStarMg, TreesAreWholeAndFree) {
  const ManipulationProblem problem = bar_transfer();
  for (const int samples : {60, 1500}) {
    ManipulationOptions options = tree_options(samples);
    options.rrt.keep_trees = true;
    const ManipulationResult result = plan_manipulation(problem, options);
    ASSERT_FALSE(result.trees.empty());
    std::size_t edges = 0;
    for (const SearchTree& tree : result.trees) {
      const Grasp& grasp = problem.grasps[tree.grasp];
      CollisionChecker checker(problem.group, test::carrying(problem, grasp));
      const Pose T_world_tip = (tree.from_goal ? problem.T_world_goal : problem.T_world_start) * grasp.T_object_hand;
      ASSERT_EQ(tree.vertices.cols(), static_cast<Eigen::Index>(tree.parents.size()));
      int roots = 0;
      for (std::size_t i = 0; i < tree.parents.size(); ++i) {
        const auto col = static_cast<Eigen::Index>(i);
        const Eigen::VectorXd q = tree.vertices.col(col);
        EXPECT_TRUE(problem.group.within_limits(q, 1e-9));
        if (tree.parents[i] < 0) {
          ++roots;
          EXPECT_EQ(tree.costs[col], 0);
          EXPECT_LT((problem.group.fk(q).matrix() - T_world_tip.matrix()).norm(), 3e-4);
          continue;
        }
        ++edges;
        const Eigen::VectorXd p = tree.vertices.col(tree.parents[i]);
        EXPECT_NEAR(tree.costs[col], tree.costs[tree.parents[i]] + (q - p).norm(), 1e-9);
        // At the steps in which the trees' edges are checked.
        EXPECT_TRUE(checker.edge_is_free(p, q, options.edge.joint_step));
        std::size_t steps = 0;
        for (int v = static_cast<int>(i); v >= 0; v = tree.parents[v]) ASSERT_LE(++steps, tree.parents.size());
      }
      EXPECT_GE(roots, 1);
      EXPECT_LE(roots, options.ik_solutions);
    }
    EXPECT_GT(edges, 10u);
  }
}

TEST(RrtStarMg, SamplesAloneDecideAtAnyNumberOfThreads) {
  const ManipulationProblem problem = bar_transfer();
  for (unsigned seed = 1; seed <= 3; ++seed) {
    std::vector<ManipulationResult> results;
    for (const int threads : {1, 2, 5}) {
      ManipulationOptions options = tree_options(400);
      options.threads = threads;
      options.seed = seed;
      results.push_back(plan_manipulation(problem, options));
    }
    for (const ManipulationResult& result : results) {
      ASSERT_EQ(result.outcome, Outcome::solved);
      EXPECT_EQ(result.path->waypoints, results[0].path->waypoints);
      EXPECT_EQ(result.cost, results[0].cost);
      EXPECT_EQ(result.grasp_index, results[0].grasp_index);
      EXPECT_EQ(result.stats.samples, results[0].stats.samples);
      EXPECT_EQ(result.improvements.size(), results[0].improvements.size());
    }
  }
}

TEST(RrtStarMg, CostsOfGraspsCount) {
  ManipulationProblem problem = bar_transfer();
  const ManipulationResult cheap = plan_manipulation(problem, tree_options());
  expect_sound(problem, cheap);
  problem.grasps[cheap.grasp_index].cost = 100;
  const ManipulationResult other = plan_manipulation(problem, tree_options());
  expect_sound(problem, other);
  EXPECT_NE(other.grasp_index, cheap.grasp_index);
  EXPECT_LT(other.cost, 100);
}

TEST(RrtStarMg, OneReachableGraspOfManyIsFound) {
  const ManipulationProblem all = bar_transfer();
  const ManipulationResult any = plan_manipulation(all, tree_options());
  ASSERT_EQ(any.outcome, Outcome::solved);
  ManipulationProblem problem = all;
  // 500 grasps beyond the arm's reach, and one within it, somewhere among them.
  problem.grasps.assign(500, {flat_pose(2.5, 0, 0), 0, 0});
  for (std::size_t i = 0; i < 500; ++i)
    problem.grasps[i].T_object_hand.translation().x() += 0.001 * static_cast<double>(i);
  problem.grasps[317] = all.grasps[any.grasp_index];
  for (unsigned seed = 1; seed <= 20; ++seed) {
    ManipulationOptions options = tree_options();
    options.seed = seed;
    options.rrt.goal_cost = std::numeric_limits<double>::infinity();
    options.ik.restarts = 3;
    const ManipulationResult result = plan_manipulation(problem, options);
    expect_sound(problem, result);
    EXPECT_EQ(result.grasp_index, 317);
    EXPECT_LE(result.improvements.size(), 2u);  // Once more when waypoints could go.
  }
}

TEST(RrtStarMg, RefusesNonsense) {
  const auto refused = [](const char* field, const auto& change) {
    ManipulationOptions options = tree_options();
    change(options.rrt);
    try {
      plan_manipulation(bar_transfer(), options);
      ADD_FAILURE() << field;
    } catch (const InvalidInput& error) {
      EXPECT_NE(std::string(error.what()).find(field), std::string::npos) << error.what();
    }
  };
  refused("max_iterations", [](RrtStarMgOptions& o) { o.max_iterations = 0; });
  refused("range", [](RrtStarMgOptions& o) { o.range = 0; });
  refused("range", [](RrtStarMgOptions& o) { o.range = std::nan(""); });
  refused("gamma", [](RrtStarMgOptions& o) { o.gamma = -1; });
  refused("exploration", [](RrtStarMgOptions& o) { o.exploration = 1.5; });
  refused("goal_cost", [](RrtStarMgOptions& o) { o.goal_cost = std::nan(""); });
}

}  // namespace
}  // namespace mmgrasp
