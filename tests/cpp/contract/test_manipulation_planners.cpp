// What every planner of manipulation_planner_names() promises.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <limits>
#include <string>
#include <thread>

#include "mmgrasp/core/error.hpp"
#include "support/fcl_transfer.hpp"

namespace mmgrasp {
namespace {

using test::flat_pose;

/// A bar moved by an arm of three links past two posts, with twenty grasps.
class ManipulationPlanner : public ::testing::TestWithParam<std::string> {
 protected:
  ManipulationOptions options() const {
    ManipulationOptions options;
    options.planner = GetParam();
    options.ik_solutions = 2;
    options.time_limit = 100;  // Not to end a run: the budgets do.
    options.seed = 3;
    options.prm.roadmap.vertices = 300;
    options.rrt.max_iterations = 600;
    return options;
  }

  /// A wall from the first joint on that no link can swing through; its limits forbid a path round the back.
  static ManipulationProblem walled() {
    ManipulationProblem problem = test::bar_transfer();
    problem.world.add("wall", Shape(Box{{1.3, 0.02, 0.2}}), flat_pose(0.75, 0, 0));
    return problem;
  }

  static void expect_sound(const ManipulationProblem& problem, const ManipulationResult& result) {
    ASSERT_EQ(result.outcome, Outcome::solved);
    ASSERT_TRUE(result.path);
    ASSERT_GE(result.grasp_index, 0);
    const Grasp& grasp = problem.grasps[result.grasp_index];
    EXPECT_TRUE(test::FclTransfer(problem, result.grasp_index, 0.4, 0.02).is_free(*result.path, 0.005));
    const auto object_at = [&](const Eigen::VectorXd& q) {
      Pose T = Pose::Identity();
      for (Eigen::Index i = 0; i < q.size(); ++i) T = T * flat_pose(0, 0, q[i]) * flat_pose(0.4, 0, 0);
      return Pose(T * grasp.T_object_hand.inverse());
    };
    EXPECT_LT((object_at(result.path->waypoints.front()).matrix() - problem.T_world_start.matrix()).norm(), 3e-4);
    EXPECT_LT((object_at(result.path->waypoints.back()).matrix() - problem.T_world_goal.matrix()).norm(), 3e-4);
    for (const Eigen::VectorXd& q : result.path->waypoints) EXPECT_TRUE(problem.group.within_limits(q, 1e-9));
    EXPECT_NEAR(result.cost, result.path->length() + grasp.cost, 1e-9);
    EXPECT_LE(result.lower_bound, result.stats.postures_bound);
    EXPECT_LE(result.stats.postures_bound, result.cost + 1e-9);
    ASSERT_FALSE(result.improvements.empty());
    EXPECT_EQ(result.improvements.back().cost, result.cost);
    EXPECT_EQ(result.improvements.back().grasp, result.grasp_index);
  }
};

TEST_P(ManipulationPlanner, SolvesAndThePathIsFreeByFcl) {
  const ManipulationProblem problem = test::bar_transfer();
  ManipulationOptions options = this->options();
  options.straight = false;
  double last = std::numeric_limits<double>::infinity();
  std::size_t reported = 0;
  const ManipulationResult result = plan_manipulation(problem, options, nullptr, {}, [&](const Improvement& better) {
    EXPECT_LT(better.cost, last);
    last = better.cost;
    ++reported;
  });
  expect_sound(problem, result);
  EXPECT_EQ(result.cost, last);
  EXPECT_EQ(result.improvements.size(), reported);
  EXPECT_EQ(result.grasps.size(), problem.grasps.size());
}

TEST_P(ManipulationPlanner, SameSeedSamePathAtAnyNumberOfThreads) {
  const ManipulationProblem problem = test::bar_transfer();
  ManipulationOptions options = this->options();
  options.threads = 1;
  options.straight = false;
  const ManipulationResult expected = plan_manipulation(problem, options);
  ASSERT_EQ(expected.outcome, Outcome::solved);
  for (const int threads : {1, 2, 3, 7}) {
    options.threads = threads;
    const ManipulationResult result = plan_manipulation(problem, options);
    ASSERT_TRUE(result.path);
    EXPECT_EQ(result.path->waypoints, expected.path->waypoints);
    EXPECT_EQ(result.grasp_index, expected.grasp_index);
    EXPECT_EQ(result.cost, expected.cost);
    EXPECT_EQ(result.improvements.size(), expected.improvements.size());
    EXPECT_EQ(result.stats.graph_searches, expected.stats.graph_searches);
    EXPECT_EQ(result.stats.edges_checked_robot, expected.stats.edges_checked_robot);
    EXPECT_EQ(result.stats.edges_checked_attached, expected.stats.edges_checked_attached);
    EXPECT_EQ(result.stats.samples, expected.stats.samples);
  }
}

TEST_P(ManipulationPlanner, CallsSideBySideDoNotMeet) {
  const ManipulationProblem problem = test::bar_transfer();
  const ManipulationResult expected = plan_manipulation(problem, options());
  ASSERT_TRUE(expected.path);
  std::vector<ManipulationResult> results(2);
  std::vector<std::thread> threads;
  for (ManipulationResult& result : results)
    threads.emplace_back([&] { result = plan_manipulation(problem, options()); });
  for (std::thread& thread : threads) thread.join();
  for (const ManipulationResult& result : results) {
    ASSERT_TRUE(result.path);
    EXPECT_EQ(result.path->waypoints, expected.path->waypoints);
  }
}

TEST_P(ManipulationPlanner, WithoutObstaclesTheStraightLineIsTaken) {
  ManipulationProblem problem = test::bar_transfer();
  problem.world = World{};
  problem.T_world_goal = flat_pose(0.6, 0.3, 0.9);
  const ManipulationResult result = plan_manipulation(problem, options());
  expect_sound(problem, result);
  EXPECT_EQ(result.path->waypoints.size(), 2u);
  EXPECT_NEAR(result.cost, result.stats.postures_bound, 1e-9);
}

TEST_P(ManipulationPlanner, AGoalThatIsTheStartCostsNothing) {
  ManipulationProblem problem = test::bar_transfer();
  problem.T_world_goal = problem.T_world_start;
  const ManipulationResult result = plan_manipulation(problem, options());
  expect_sound(problem, result);
  EXPECT_NEAR(result.cost, 0, 1e-9);
}

TEST_P(ManipulationPlanner, OneGraspOfManyLeadsThere) {
  const ManipulationProblem good = test::bar_transfer();
  const ManipulationResult best = plan_manipulation(good, options());
  ASSERT_TRUE(best.path);
  for (const bool in_the_post : {false, true}) {
    ManipulationProblem problem = good;
    problem.grasps.assign(300, {flat_pose(3, 0, 0), 0, 0});  // out of reach
    if (in_the_post) {
      problem.world.add("ball", Shape(Sphere{0.01}), problem.T_world_start * flat_pose(-0.05, 0.2, 0));
      // The third link crosses the ball.
      problem.grasps.assign(300, {flat_pose(-0.05, 0, 0.5 * M_PI), 0, 0});
      for (int side : {1, -1}) problem.grasps.push_back({flat_pose(-0.05, 0, side * 0.5 * M_PI), 0, 0});
    }
    problem.grasps.insert(problem.grasps.begin() + 137, good.grasps[best.grasp_index]);
    const ManipulationResult result = plan_manipulation(problem, options());
    ASSERT_EQ(result.outcome, Outcome::solved);
    EXPECT_EQ(result.grasps.size(), problem.grasps.size());
    if (!in_the_post) {
      EXPECT_EQ(result.grasp_index, 137);
      EXPECT_EQ(result.rejections.unreachable, 300u);
    }
  }
}

TEST_P(ManipulationPlanner, AGraspsCostCounts) {
  ManipulationProblem problem = test::bar_transfer();
  const ManipulationResult cheap = plan_manipulation(problem, options());
  ASSERT_TRUE(cheap.path);
  problem.grasps[cheap.grasp_index].cost = 1000;
  const ManipulationResult other = plan_manipulation(problem, options());
  ASSERT_TRUE(other.path);
  EXPECT_NE(other.grasp_index, cheap.grasp_index);
  EXPECT_LT(other.cost, 1000);
}

TEST_P(ManipulationPlanner, AnImpossibleProblemEndsByItsBudget) {
  const ManipulationProblem problem = walled();
  const ManipulationResult result = plan_manipulation(problem, options());
  EXPECT_TRUE(result.outcome == Outcome::timeout || result.outcome == Outcome::not_found) << to_string(result.outcome);
  EXPECT_FALSE(result.path);
  EXPECT_EQ(result.grasp_index, -1);
  EXPECT_TRUE(result.improvements.empty());
  const ManipulationResult again = plan_manipulation(problem, options());
  EXPECT_EQ(again.outcome, result.outcome);
  EXPECT_EQ(again.stats.edges_checked_robot, result.stats.edges_checked_robot);
}

TEST_P(ManipulationPlanner, TheCancelTokenEndsIt) {
  ManipulationOptions options = this->options();
  options.rrt.max_iterations = 10000000;
  options.prm.roadmap.vertices = 300000;
  Monitor monitor;
  std::thread stopper([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    monitor.stop.stop();
  });
  const ManipulationResult result = plan_manipulation(walled(), options, nullptr, monitor);
  stopper.join();
  EXPECT_EQ(result.outcome, Outcome::stopped);
  EXPECT_FALSE(result.path);
}

TEST_P(ManipulationPlanner, AStopBeforehandIsHeeded) {
  Monitor monitor;
  monitor.stop.stop();
  EXPECT_EQ(plan_manipulation(test::bar_transfer(), options(), nullptr, monitor).outcome, Outcome::stopped);
}

TEST_P(ManipulationPlanner, TheClockIsACap) {
  ManipulationOptions options = this->options();
  options.time_limit = 1e-9;
  const ManipulationResult result = plan_manipulation(walled(), options);
  EXPECT_EQ(result.outcome, Outcome::timeout);
  EXPECT_FALSE(result.path);
}

/// A monitor that calls `act` once, when a part of the search, but not all of it, is done.
Monitor within_search(std::function<void()> act) {
  Monitor monitor;
  monitor.progress = [act = std::move(act), done = false](const std::string& stage, double fraction) mutable {
    if (done || stage != "search" || fraction <= 0 || fraction >= 1) return;
    done = true;
    act();
  };
  return monitor;
}

TEST_P(ManipulationPlanner, ClockAndCancelTokenEndASearchThatHasBegun) {
  ManipulationOptions options = this->options();
  options.first_grasps = 0;
  options.prm.batch = 3;
  const ManipulationResult whole = plan_manipulation(walled(), options);
  for (const bool by_clock : {true, false}) {
    options.time_limit = by_clock ? 1.0 : 100.0;
    Monitor monitor;
    monitor = within_search([&] {
      // The time limit passes here, wherever the call is.
      if (by_clock) std::this_thread::sleep_for(std::chrono::duration<double>(options.time_limit));
      if (!by_clock) monitor.stop.stop();
    });
    const ManipulationResult cut = plan_manipulation(walled(), options, nullptr, monitor);
    EXPECT_EQ(cut.outcome, by_clock ? Outcome::timeout : Outcome::stopped);
    EXPECT_FALSE(cut.path);
    EXPECT_GT(cut.stats.samples + cut.stats.graph_searches, 0u);
    EXPECT_LT(cut.stats.samples + cut.stats.graph_searches, whole.stats.samples + whole.stats.graph_searches);
  }
}

TEST_P(ManipulationPlanner, StopsWithWhatItHas) {
  ManipulationOptions options = this->options();
  options.rrt.max_iterations = 10000000;
  options.prm.max_vertices = 10000000;
  Monitor monitor;
  const ManipulationProblem problem = test::bar_transfer();
  const ManipulationResult result =
      plan_manipulation(problem, options, nullptr, monitor, [&](const Improvement&) { monitor.stop.stop(); });
  expect_sound(problem, result);
}

/// The bar's grasps many times over.
ManipulationProblem with_many_grasps() {
  ManipulationProblem problem = test::bar_transfer();
  const std::vector<Grasp> once = problem.grasps;
  for (int i = 1; i < 15; ++i) problem.grasps.insert(problem.grasps.end(), once.begin(), once.end());
  return problem;
}

TEST_P(ManipulationPlanner, TheFirstPathNeedNotWaitForAllGrasps) {
  ManipulationOptions options = this->options();
  const ManipulationProblem problem = with_many_grasps();
  for (const int first_grasps : {4, 0}) {
    options.first_grasps = first_grasps;
    Monitor monitor;
    const ManipulationResult result =
        plan_manipulation(problem, options, nullptr, monitor, [&](const Improvement&) { monitor.stop.stop(); });
    expect_sound(problem, result);
    const auto looked_at = std::count_if(result.grasps.begin(), result.grasps.end(), [](const GraspReport& report) {
      return report.start.total() > 0 || report.start_solutions > 0;
    });
    if (first_grasps == 0) {
      EXPECT_EQ(looked_at, 300);
    } else {
      EXPECT_LT(looked_at, 150);
    }
  }
}

TEST_P(ManipulationPlanner, AFirstPathNeedsTheEndsOfFewGrasps) {
  const ManipulationProblem all = test::bar_transfer();
  const ManipulationResult any = plan_manipulation(all, options());
  ASSERT_TRUE(any.path);
  ManipulationProblem problem = all;
  // Whichever comes first will do, but none of them straight.
  problem.grasps.assign(200, all.grasps[any.grasp_index]);
  for (unsigned seed = 1; seed <= 10; ++seed) {
    std::vector<ManipulationResult> results;
    for (const int threads : {1, 3}) {
      ManipulationOptions options = this->options();
      options.seed = seed;
      options.threads = threads;
      Monitor monitor;
      results.push_back(
          plan_manipulation(problem, options, nullptr, monitor, [&](const Improvement&) { monitor.stop.stop(); }));
      expect_sound(problem, results.back());
      EXPECT_GT(results.back().path->waypoints.size(), 2u);
      const auto looked_at = std::count_if(
          results.back().grasps.begin(), results.back().grasps.end(),
          [](const GraspReport& report) { return report.start.total() > 0 || report.start_solutions > 0; });
      EXPECT_LE(looked_at, 4) << seed;
    }
    EXPECT_EQ(results[0].path->waypoints, results[1].path->waypoints);
  }
}

TEST_P(ManipulationPlanner, TheFirstPathDoesNotEndTheSearch) {
  const ManipulationProblem problem = test::bar_transfer();
  for (unsigned seed = 1; seed <= 5; ++seed) {
    ManipulationOptions options = this->options();
    options.seed = seed;
    options.first_grasps = 0;
    const ManipulationResult without = plan_manipulation(problem, options);
    options.first_grasps = 4;
    const ManipulationResult with = plan_manipulation(problem, options);
    expect_sound(problem, with);
    ASSERT_TRUE(without.path);
    EXPECT_LE(with.cost, with.improvements.front().cost);
    EXPECT_LE(with.stats.roadmap_cost, with.improvements.front().cost);
    if (GetParam() == "prm_star_mg") {
      // The roadmap's optimum, whatever the bound it was found with, or a first path cheaper than it.
      if (with.stats.roadmap_cost > 0) {
        EXPECT_NEAR(with.stats.roadmap_cost, without.stats.roadmap_cost, 1e-9);
      } else {
        EXPECT_LE(with.cost, without.stats.roadmap_cost * (1 + 1e-9));
      }
    }
  }
}

TEST_P(ManipulationPlanner, EveryGraspIsCheckedInAnyOrder) {
  ManipulationOptions options = this->options();
  const ManipulationProblem problem = with_many_grasps();
  options.first_grasps = 0;
  const ManipulationResult expected = plan_manipulation(problem, options);
  for (const int first_grasps : {1, 4, 1000}) {
    options.first_grasps = first_grasps;
    const ManipulationResult result = plan_manipulation(problem, options);
    ASSERT_EQ(result.grasps.size(), expected.grasps.size());
    for (std::size_t i = 0; i < result.grasps.size(); ++i) {
      EXPECT_EQ(result.grasps[i].start_solutions, expected.grasps[i].start_solutions);
      EXPECT_EQ(result.grasps[i].goal_solutions, expected.grasps[i].goal_solutions);
      EXPECT_EQ(result.grasps[i].start.total(), expected.grasps[i].start.total());
      EXPECT_EQ(result.grasps[i].goal.total(), expected.grasps[i].goal.total());
    }
    EXPECT_EQ(result.rejections.scene, expected.rejections.scene);
    EXPECT_EQ(result.rejections.self_collision, expected.rejections.self_collision);
  }
  options.first_grasps = -1;
  EXPECT_THROW(plan_manipulation(problem, options), InvalidInput);
}

TEST_P(ManipulationPlanner, AnInvalidStartSaysWhy) {
  ManipulationProblem problem = test::bar_transfer();
  problem.T_world_start = flat_pose(0.85, 0, 0.5 * M_PI);  // through the post
  ManipulationResult result = plan_manipulation(problem, options());
  EXPECT_EQ(result.outcome, Outcome::invalid_start);
  EXPECT_FALSE(result.path);
  EXPECT_GT(result.rejections.scene, 0u);
  ASSERT_FALSE(result.contacts.empty());
  EXPECT_EQ(result.contacts.front().b, "post");
  for (const GraspReport& report : result.grasps) EXPECT_GT(report.start.total(), 0u);
  std::swap(problem.T_world_start, problem.T_world_goal);
  problem.T_world_start = test::bar_transfer().T_world_start;
  result = plan_manipulation(problem, options());
  EXPECT_EQ(result.outcome, Outcome::invalid_goal);
  EXPECT_FALSE(result.contacts.empty());
  problem.T_world_start = flat_pose(9, 0, 0);
  result = plan_manipulation(problem, options());
  EXPECT_EQ(result.outcome, Outcome::invalid_start);
  EXPECT_EQ(result.rejections.unreachable, problem.grasps.size());
  EXPECT_TRUE(result.contacts.empty());
}

INSTANTIATE_TEST_SUITE_P(All, ManipulationPlanner, ::testing::ValuesIn(manipulation_planner_names()),
                         [](const auto& info) { return info.param; });

TEST(ManipulationPlannerTable, AWrongNameListsTheKnownOnes) {
  ManipulationOptions options;
  options.planner = "prm";
  try {
    plan_manipulation(test::bar_transfer(), options);
    FAIL() << "an unknown planner was taken";
  } catch (const InvalidInput& error) {
    for (const std::string& name : manipulation_planner_names())
      EXPECT_NE(std::string(error.what()).find(name), std::string::npos);
  }
}

}  // namespace
}  // namespace mmgrasp
