// RRT*-MG with its default options against exact optima: a gantry past walls and boxes (benchmarks/planners/
// bench_rrt_star_mg_convergence.cpp goes on to 100,000 samples and to an arm).
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <ostream>
#include <string>
#include <vector>

#include "mmgrasp/plan/time_parameterization.hpp"
#include "support/bar_transfer.hpp"
#include "support/gantry_walls.hpp"

namespace mmgrasp {
namespace {

// Edges are checked in steps of 5 mm. Between two of them an edge may cut the corner of a wall, by which a path of
// 1.5 m around two or four corners gets shorter by this share at most.
constexpr double kStepsShare = 0.003;

ManipulationOptions tree_options(int samples, unsigned seed) {
  ManipulationOptions options;
  options.planner = "rrt_star_mg";
  options.rrt.max_iterations = samples;
  options.time_limit = 1000;
  options.seed = seed;
  return options;
}

struct Scene {
  const char* name;
  std::vector<test::Rectangle> walls;
  bool wrist;
  int samples;
  unsigned seeds;
  double share = 0.01;  ///< Above the optimum, at most.
  unsigned first = 1;   ///< Seed.
};

std::ostream& operator<<(std::ostream& out, const Scene& scene) {
  return out << scene.name;
}

class RrtStarMgConverges : public ::testing::TestWithParam<Scene> {};

TEST_P(RrtStarMgConverges, ToTheExactOptimum) {
  const test::GantryWalls scene = test::gantry_walls_problem(GetParam().walls, GetParam().wrist);
  for (unsigned seed = GetParam().first; seed < GetParam().first + GetParam().seeds; ++seed) {
    const ManipulationResult result = plan_manipulation(scene.problem, tree_options(GetParam().samples, seed));
    ASSERT_TRUE(result.path) << "seed " << seed;
    EXPECT_LT(result.cost, (1 + GetParam().share) * scene.optimum) << "seed " << seed;
    EXPECT_GT(result.cost, (1 - kStepsShare) * scene.optimum) << "seed " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, RrtStarMgConverges,
    ::testing::Values(Scene{"ThinWall", test::wall_with_door(0.002), false, 2000, 20},
                      Scene{"ThickWall", test::wall_with_door(0.08), false, 2000, 20},
                      Scene{"TwoWalls", test::two_walls(), false, 2000, 20},
                      Scene{"Boxes", test::boxes(), false, 2000, 20},
                      Scene{"ThinWallSixJoints", test::wall_with_door(0.002), true, 5000, 20, 0.002},
                      // Seed 30: the path cuts the wall's corner between two steps, where its other joints must move.
                      Scene{"CutCornerSixJoints", test::wall_with_door(0.002), true, 20000, 5, 0.002, 28},
                      Scene{"ThickWallSixJoints", test::wall_with_door(0.08), true, 5000, 20, 0.002},
                      Scene{"TwoWallsSixJoints", test::two_walls(), true, 5000, 20, 0.002},
                      Scene{"BoxesSixJoints", test::boxes(), true, 20000, 5}),
    [](const auto& info) { return std::string(info.param.name); });

/// The cost after so many samples, from the reports of one run.
std::vector<double> cost_curve(const ManipulationProblem& problem, const ManipulationOptions& options,
                               const std::vector<int>& marks) {
  std::vector<double> out(marks.size(), std::numeric_limits<double>::infinity());
  double done = 0;
  Monitor monitor;
  monitor.progress = [&](const std::string& stage, double fraction) {
    if (stage == "search") done = fraction * options.rrt.max_iterations;
  };
  plan_manipulation(problem, options, nullptr, monitor, [&](const Improvement& better) {
    for (std::size_t i = 0; i < marks.size(); ++i)
      if (done < marks[i]) out[i] = better.cost;
  });
  return out;
}

/// One grasp: its first path is known before the trees, which must not wait for another one.
TEST(RrtStarMgFirstPath, HelpsTheTreesAtAllTimes) {
  ManipulationProblem problem = test::bar_transfer();
  problem.world.add("wall", Shape(Box{{0.04, 0.3, 0.2}}), test::flat_pose(0.62, 0.02, 0.3));
  const ManipulationResult any = plan_manipulation(problem, tree_options(1000, 1));
  ASSERT_TRUE(any.path);
  problem.grasps = {problem.grasps[any.grasp_index]};
  const std::vector<int> marks{500, 1000, 2000, 5000};
  constexpr unsigned kPairs = 60;
  std::vector<double> worse(marks.size(), 0), squares(marks.size(), 0);  // By what share of the cost, of each pair.
  for (unsigned seed = 1; seed <= kPairs; ++seed) {
    ManipulationOptions options = tree_options(marks.back(), seed);
    const std::vector<double> own = cost_curve(problem, options, marks);
    options.first_grasps = 0;
    const std::vector<double> other = cost_curve(problem, options, marks);
    for (std::size_t i = 0; i < marks.size(); ++i) {
      const double share = own[i] / other[i] - 1;
      worse[i] += share / kPairs;
      squares[i] += share * share / kPairs;
    }
  }
  for (std::size_t i = 0; i < marks.size(); ++i) {
    const double half_interval = 1.96 * std::sqrt((squares[i] - worse[i] * worse[i]) / kPairs);  // 95 %
    EXPECT_LE(worse[i], 0.001 + half_interval) << marks[i];
  }
}

/// Paths fit to drive: no waypoint could go, there are few of them, and shortening once more makes the motion no more
/// than 2 % faster. For both planners.
TEST(ManipulationPaths, HaveNoRedundantWaypoints) {
  for (const char* planner : {"rrt_star_mg", "prm_star_mg"})
    for (const double thickness : {0.002, 0.08})
      for (unsigned seed = 1; seed <= 2; ++seed) {
        const ManipulationProblem problem = test::gantry_walls_problem(test::wall_with_door(thickness), false).problem;
        ManipulationOptions options = tree_options(1000, seed);
        options.planner = planner;
        const ManipulationResult result = plan_manipulation(problem, options);
        ASSERT_TRUE(result.path);
        const auto& waypoints = result.path->waypoints;
        EXPECT_LE(waypoints.size(), 12u) << planner << " seed " << seed;
        World world = problem.world;
        world.add("object", WorldObject{problem.object, problem.T_world_start});
        world.attach("object", "stage", problem.grasps[0].T_object_hand.inverse(), problem.touch_links);
        CollisionChecker checker(problem.group, world);
        // As finished paths are checked.
        const double step = 0.005 / 16;
        const EdgeOptions by_both{step, step, false, 1e-4};
        const auto is_free = [&](const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
          return check_edge(checker, a, b, by_both).free && checker.edge_is_free(a, b, step);
        };
        for (std::size_t i = 1; i + 1 < waypoints.size(); ++i)
          EXPECT_FALSE(is_free(waypoints[i - 1], waypoints[i + 1])) << planner << " seed " << seed << " at " << i;
        // By hand: skips waypoints wherever the edge is free, so that nothing is left to skip.
        std::vector<Eigen::VectorXd> shortened{waypoints.front()};
        for (std::size_t i = 0; i + 1 < waypoints.size();) {
          std::size_t next = waypoints.size() - 1;
          while (next > i + 1 && !is_free(waypoints[i], waypoints[next])) --next;
          shortened.push_back(waypoints[i = next]);
        }
        const Eigen::VectorXd one = Eigen::VectorXd::Ones(2);
        EXPECT_LT(time_parameterize(*result.path, one, one).times.back(),
                  1.02 * time_parameterize(JointPath{shortened}, one, one).times.back())
            << planner << " seed " << seed;
      }
}

}  // namespace
}  // namespace mmgrasp
