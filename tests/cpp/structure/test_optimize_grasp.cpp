#include "mmgrasp/structure/optimize_grasp.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "carried_pipe.hpp"
#include "mmgrasp/core/error.hpp"
#include "structure/object_path/grasp_variables.hpp"

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
              evaluator.evaluate(place_pipe_grasp(pipe, section, at, angle, flip, puma_tool()));
          if (found.outcome == Outcome::solved) least = std::min(least, found.cost);
        }
      }
    }
  }
  return least;
}

TEST(OptimizeGrasp, EveryAlgorithmComesNearTheGridsBest) {
  const ObjectPathProblem problem = arc_past_post(6);
  const double grid = least_of_grid(problem, 0.01, M_PI / 36);
  ASSERT_TRUE(std::isfinite(grid));
  for (const std::string& name : population_search_names()) {
    GraspSearchOptions options;
    options.algorithm = name;
    options.grasp = puma_tool();
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

/// What every name of grasp_search_names() promises.
class GraspSearch : public ::testing::TestWithParam<std::string> {
 protected:
  GraspSearch() {
    options_.algorithm = GetParam();
    options_.grasp = puma_tool();
    options_.population.max_evaluations = 200;
    options_.max_boxes = 400;
  }
  bool proves() const { return GetParam() == "branch_and_bound"; }
  GraspOptimum run(const Monitor& monitor = {}) const {
    return optimize_grasp(problem_, figure_3_4(), {}, options_, monitor);
  }
  ObjectPathProblem problem_ = arc_past_post(6);
  GraspSearchOptions options_;
};

TEST_P(GraspSearch, CountsWhatItTries) {
  const GraspOptimum found = run();
  ASSERT_FALSE(found.feasible.empty());
  EXPECT_EQ(found.history.size(), 200u);
  EXPECT_EQ(found.evaluations > 200, proves());  // middles of boxes count
  EXPECT_LE(static_cast<int>(found.feasible.size()), found.evaluations);
  for (const FeasibleGrasp& each : found.feasible) {
    const ObjectPathResult again = ObjectPathEvaluator(problem_).evaluate(each.grasp);
    EXPECT_EQ(again.outcome, Outcome::solved);
    EXPECT_NEAR(again.cost, each.grasp.cost, 1e-9);
  }
  EXPECT_TRUE(std::is_sorted(found.feasible.begin(), found.feasible.end(),
                             [](const auto& a, const auto& b) { return a.grasp.cost < b.grasp.cost; }));
}

TEST_P(GraspSearch, SaysTheSameAtAnyNumberOfThreads) {
  options_.threads = 1;
  const GraspOptimum one = run();
  options_.threads = 3;
  const GraspOptimum three = run();
  EXPECT_EQ(one.evaluations, three.evaluations);
  EXPECT_EQ(one.unreachable, three.unreachable);
  EXPECT_EQ(one.colliding, three.colliding);
  EXPECT_EQ(one.lower_bound, three.lower_bound);
  ASSERT_EQ(one.feasible.size(), three.feasible.size());
  for (std::size_t i = 0; i < one.feasible.size(); ++i)
    EXPECT_EQ(one.feasible[i].grasp.cost, three.feasible[i].grasp.cost);
}

TEST_P(GraspSearch, EndsWhenAskedTo) {
  Monitor monitor;
  monitor.progress = [&](const std::string& stage, double) {
    if (!proves() || stage == "branch and bound") monitor.stop.stop();
  };
  options_.max_boxes = 1000000;
  options_.max_gap = 1e-9;  // would take for ever
  const GraspOptimum found = run(monitor);
  EXPECT_EQ(found.outcome, Outcome::stopped);
  if (proves()) {
    EXPECT_EQ(found.history.size(), 200u);
    EXPECT_LT(found.boxes, 200);
    EXPECT_LE(found.lower_bound, found.path.cost);
  } else {
    EXPECT_LT(found.evaluations, 200);
  }
}

TEST_P(GraspSearch, KeepsItsLimits) {
  const GraspOptimum all = run();
  EXPECT_EQ(all.outcome, Outcome::approximate);  // 400 boxes do not prove it
  EXPECT_EQ(all.boxes > 0, proves());
  EXPECT_LE(all.boxes, 400 + 2 * 16);  // what a round divides
  EXPECT_LE(all.lower_bound, all.path.cost);
  options_.time_limit = 1e-9;
  options_.max_boxes = 1000000;
  const GraspOptimum none = run();  // time is up for the first search, too, which ends its round
  EXPECT_EQ(none.boxes, 0);
  EXPECT_GT(none.evaluations, 0);
  EXPECT_LT(none.evaluations, all.evaluations);
  EXPECT_EQ(none.outcome, none.feasible.empty() ? Outcome::not_found : Outcome::approximate);
  EXPECT_EQ(none.lower_bound, 0);
  options_.max_boxes = 0;
  EXPECT_THROW(run(), InvalidInput);
}

INSTANTIATE_TEST_SUITE_P(All, GraspSearch, ::testing::ValuesIn(grasp_search_names()),
                         [](const auto& info) { return info.param; });

TEST(OptimizeGrasp, TargetEndsIt) {
  GraspSearchOptions options;
  options.grasp = puma_tool();
  const ObjectPathProblem problem = arc_past_post(6);
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
  options.grasp = puma_tool();
  const GraspOptimum best = optimize_grasp(arc_past_post(6), figure_3_4(), {}, options);
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

using Costs = std::array<double, 3>;

/// How far the worst covered place of a grid's front is from the nearest one found, as a share of what the grid's front
/// spans: found costs may exceed it by that much in no objective.
double farthest(const std::vector<Costs>& front, const std::vector<Costs>& found) {
  Costs least = front[0], most = front[0];
  for (const Costs& each : front) {
    for (int k = 0; k < 3; ++k) {
      least[k] = std::min(least[k], each[k]);
      most[k] = std::max(most[k], each[k]);
    }
  }
  double worst = 0;
  for (const Costs& wanted : front) {
    double nearest = std::numeric_limits<double>::infinity();
    for (const Costs& each : found) {
      double over = 0;
      for (int k = 0; k < 3; ++k) over = std::max(over, (each[k] - wanted[k]) / (most[k] - least[k]));
      nearest = std::min(nearest, over);
    }
    worst = std::max(worst, nearest);
  }
  return worst;
}

TEST(OptimizeGrasp, FrontSearchesCoverTheFrontOfAGrid) {
  const ObjectPathProblem problem = arc_past_post(5);
  ObjectPathEvaluator evaluator(problem);
  std::vector<Costs> all, front;
  for (int section = 0; section < 6; ++section) {
    for (double at = 0.02; at <= figure_3_4().length(section) - 0.02 + 1e-9; at += 0.01) {
      for (int degree = -180; degree < 180; degree += 5) {
        const auto found =
            evaluator.evaluate(place_pipe_grasp(figure_3_4(), section, at, degree * M_PI / 180, false, puma_tool()));
        if (found.outcome == Outcome::solved)
          all.push_back({found.joint_motion, found.deflection, found.force_manipulability});
      }
    }
  }
  for (const Costs& a : all) {
    const bool beaten = std::any_of(
        all.begin(), all.end(), [&](const Costs& b) { return b != a && b[0] <= a[0] && b[1] <= a[1] && b[2] <= a[2]; });
    if (!beaten) front.push_back(a);
  }
  ASSERT_GT(front.size(), 20u);
  const auto searched = [&](int front_searches) {
    GraspSearchOptions options;
    options.grasp = puma_tool();
    options.population.max_evaluations = 1000;
    options.front_searches = front_searches;
    const GraspOptimum found = optimize_grasp(problem, figure_3_4(), {}, options);
    EXPECT_EQ(found.evaluations, 1000 * (1 + front_searches));
    EXPECT_EQ(found.history.size(), 1000u);
    std::vector<Costs> costs;
    for (const int i : found.front) {
      const FeasibleGrasp& each = found.feasible[i];
      costs.push_back({each.joint_motion, each.deflection, each.force_manipulability});
    }
    return farthest(front, costs);
  };
  const double passed = searched(0), looked_for = searched(12);
  EXPECT_LT(looked_for, 0.05);
  EXPECT_LT(looked_for, 0.5 * passed);
}

TEST(OptimizeGrasp, OutOfReachSaysWhere) {
  ObjectPathProblem problem = arc_past_post(6);
  problem.T_world_object[4].translation() = Vector3d(4, 0, 0);
  GraspSearchOptions options;
  options.grasp = puma_tool();
  options.population.max_evaluations = 200;
  const GraspOptimum none = optimize_grasp(problem, figure_3_4(), {}, options);
  EXPECT_EQ(none.outcome, Outcome::not_found);
  EXPECT_TRUE(none.feasible.empty());
  EXPECT_EQ(none.unreachable[4], 200);
  options.grasp.max_opening = 0.01;  // thinner than the pipe
  EXPECT_THROW(optimize_grasp(problem, figure_3_4(), {}, options), InvalidInput);
}

TEST(GraspVariables, NeighboursGoWhereTheirStrategySays) {
  const detail::GraspVariables grasps(figure_3_4(), puma_tool());
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
