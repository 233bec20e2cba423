#include "mmgrasp/structure/optimize_grasp.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "beam_frames.hpp"
#include "mmgrasp/core/error.hpp"
#include "structure/object_path/grasp_variables.hpp"
#include "turning_path.hpp"

namespace mmgrasp {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

/// Least cost over a grid of grasps.
double least_of_grid(const ObjectPathProblem& problem, double step, double turn) {
  ObjectPathEvaluator evaluator(problem);
  const Pipe pipe = figure_3_4();
  double least = std::numeric_limits<double>::infinity();
  for (int section = 0; section < 6; ++section) {
    for (double at = 0.02; at <= pipe.length(section) - 0.02 + 1e-9; at += step) {
      for (double angle = -M_PI; angle < M_PI; angle += turn) {
        for (const bool flip : {false, true}) {
          const ObjectPathResult found =
              evaluator.evaluate(place_pipe_grasp(pipe, section, at, angle, flip, pipe_tool()));
          if (found.outcome == Outcome::solved) least = std::min(least, found.cost);
        }
      }
    }
  }
  return least;
}

TEST(OptimizeGrasp, EveryAlgorithmComesNearTheGridsBest) {
  const ObjectPathProblem problem = turning_path(6);
  const double grid = least_of_grid(problem, 0.01, M_PI / 36);
  ASSERT_TRUE(std::isfinite(grid));
  for (const std::string& name : population_search_names()) {
    GraspSearchOptions options;
    options.algorithm = name;
    options.grasp = pipe_tool();
    const GraspOptimum best = optimize_grasp(problem, figure_3_4(), {}, options);
    ASSERT_EQ(best.outcome, Outcome::approximate) << name;
    EXPECT_LE(best.path.cost, 1.05 * grid) << name;
    EXPECT_EQ(best.evaluations, 1530);
    EXPECT_NEAR(best.grasp.cost, best.path.cost, 1e-9);
    EXPECT_NEAR(best.history.back(), best.path.cost, 1e-9);
    const ObjectPathResult again = follow_object_path(problem, best.grasp);
    EXPECT_EQ(again.cost, best.path.cost);
  }
}

TEST(OptimizeGrasp, TargetEndsIt) {
  GraspSearchOptions options;
  options.grasp = pipe_tool();
  const ObjectPathProblem problem = turning_path(6);
  const double found = optimize_grasp(problem, figure_3_4(), {}, options).path.cost;
  options.population.target = 1.2 * found;
  options.population.seed = 4;
  const GraspOptimum best = optimize_grasp(problem, figure_3_4(), {}, options);
  EXPECT_EQ(best.outcome, Outcome::solved);
  EXPECT_LT(best.evaluations, 1530);
  EXPECT_LE(best.path.cost, 1.2 * found);
}

TEST(OptimizeGrasp, FrontHoldsWhatNothingBeats) {
  GraspSearchOptions options;
  options.grasp = pipe_tool();
  const GraspOptimum best = optimize_grasp(turning_path(6), figure_3_4(), {}, options);
  ASSERT_GT(best.front.size(), 1u);
  EXPECT_TRUE(std::is_sorted(best.feasible.begin(), best.feasible.end(),
                             [](const auto& a, const auto& b) { return a.grasp.cost < b.grasp.cost; }));
  EXPECT_NE(std::find(best.front.begin(), best.front.end(), 0), best.front.end());  // the cheapest is never beaten
  for (int i = 0; i < static_cast<int>(best.feasible.size()); ++i) {
    const FeasibleGrasp& a = best.feasible[i];
    bool beaten = false;
    for (const FeasibleGrasp& b : best.feasible) {
      const double d[3] = {b.joint_motion - a.joint_motion, b.deflection - a.deflection,
                           b.force_manipulability - a.force_manipulability};
      beaten = beaten || (*std::max_element(d, d + 3) <= 0 && *std::min_element(d, d + 3) < 0);
    }
    EXPECT_EQ(std::count(best.front.begin(), best.front.end(), i), beaten ? 0 : 1);
  }
}

TEST(OptimizeGrasp, OutOfReachSaysWhere) {
  ObjectPathProblem problem = turning_path(6);
  problem.T_world_object[4].translation() = Vector3d(4, 0, 0);
  GraspSearchOptions options;
  options.grasp = pipe_tool();
  options.population.max_evaluations = 200;
  const GraspOptimum none = optimize_grasp(problem, figure_3_4(), {}, options);
  EXPECT_EQ(none.outcome, Outcome::not_found);
  EXPECT_TRUE(none.feasible.empty());
  EXPECT_EQ(none.unreachable[4], 200);
  options.grasp.max_opening = 0.01;  // thinner than the pipe
  EXPECT_THROW(optimize_grasp(problem, figure_3_4(), {}, options), InvalidInput);
}

TEST(GraspVariables, NeighboursGoWhereTheirStrategySays) {
  const detail::GraspVariables grasps(figure_3_4(), pipe_tool());
  Rng rng(3);
  // Section 3 begins at the node where sections 2 (its end) and 4 (its begin) meet it.
  VectorXd x(4);
  x << 3, 0.005, 0.2, 0;
  int crossed = 0, second = 0, fourth = 0;
  for (int i = 0; i < 2000; ++i) {
    const VectorXd same = grasps.neighbour(x, 0.2, GraspNeighbourhood::same_section, rng);
    EXPECT_EQ(same(0), 3);
    const VectorXd near = grasps.neighbour(x, 0.2, GraspNeighbourhood::connected_sections, rng);
    EXPECT_TRUE(near(0) == 2 || near(0) == 3 || near(0) == 4) << near.transpose();
    EXPECT_GE(near(1), 0);
    EXPECT_LE(std::abs(near(2) - 0.2), 0.2 * M_PI + 1e-12);
    const double beyond = 0.2 * 0.36 / 2 - 0.005;  // the longest section has 0.36 m between its margins
    if (near(0) == 3) continue;
    ++crossed;
    second += near(0) == 2;
    fourth += near(0) == 4;
    const double from_node = near(0) == 2 ? grasps.room(2) - near(1) : near(1);
    EXPECT_LE(from_node, beyond + 1e-12);
  }
  EXPECT_GT(crossed, 700);
  EXPECT_NEAR(second, fourth, 0.2 * crossed);
  x << 0, 0.005, 3.1, 1;  // a free end: nothing to go on to; the angle wraps
  for (int i = 0; i < 200; ++i) {
    const VectorXd near = grasps.neighbour(x, 0.2, GraspNeighbourhood::connected_sections, rng);
    EXPECT_EQ(near(0), 0);
    EXPECT_LE(std::abs(near(2)), M_PI);
  }
}

}  // namespace
}  // namespace mmgrasp
