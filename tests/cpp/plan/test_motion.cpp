#include "mmgrasp/plan/motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <future>
#include <limits>
#include <thread>

#include "mmgrasp/core/error.hpp"
#include "support/fcl_planar.hpp"
#include "support/planar_arm.hpp"
#include "support/vec.hpp"

namespace mmgrasp {
namespace {

using Eigen::VectorXd;
using test::SceneBox;
using test::vec;

constexpr double kLength = 0.4;

TEST(PlanMotion, KnowsItsPlanners) {
  const std::vector<std::string> names = planner_names();
  for (const char* name : {"rrt_connect", "rrt_star", "informed_rrt_star", "bit_star", "prm", "prm_star",
                           "lazy_prm_star", "est", "kpiece", "bkpiece"}) {
    EXPECT_NE(std::find(names.begin(), names.end(), name), names.end()) << name;
  }
}

TEST(PlanMotion, FreeSpaceIsCrossedInOneStraightEdge) {
  const test::PlanarArm arm(3, kLength);
  CollisionChecker checker(arm.group(), World{});
  const VectorXd start = vec({-1, 0.2, 0.2}), goal = vec({1, -0.2, -0.2});
  const MotionResult result = plan_motion(checker, start, {goal});
  ASSERT_EQ(result.outcome, Outcome::solved);
  EXPECT_EQ(result.path->waypoints, (std::vector<VectorXd>{start, goal}));
  EXPECT_NEAR(result.cost, (goal - start).norm(), 1e-12);
}

TEST(PlanMotion, TheNearerOfTwoGoalsInSightWins) {
  const test::PlanarArm arm(3, kLength);
  CollisionChecker checker(arm.group(), World{});
  const MotionResult result = plan_motion(checker, vec({0, 0, 0}), {vec({1, 1, 0}), vec({0.3, 0, 0})});
  EXPECT_EQ(result.goal_index, 1);
}

TEST(PlanMotion, StartAtTheGoal) {
  const test::PlanarArm arm(3, kLength);
  CollisionChecker checker(arm.group(), World{});
  const VectorXd q = vec({0.3, 0.2, 0.1});
  const MotionResult result = plan_motion(checker, q, {vec({1, 1, 1}), q});
  ASSERT_EQ(result.outcome, Outcome::solved);
  EXPECT_EQ(result.goal_index, 1);
  EXPECT_EQ(result.cost, 0);
  EXPECT_EQ(result.path->waypoints.front(), q);
  EXPECT_EQ(result.path->waypoints.back(), q);
}

TEST(PlanMotion, AnInvalidStartSaysWhatTouches) {
  const test::PlanarArm arm(3, kLength);
  CollisionChecker checker(arm.group(), test::make_world({{{1.0, 0, 0}, {0.1, 0.1, 0.1}}}));
  const MotionResult result = plan_motion(checker, vec({0, 0, 0}), {vec({1, 0, 0})});
  EXPECT_EQ(result.outcome, Outcome::invalid_start);
  EXPECT_FALSE(result.path);
  ASSERT_EQ(result.contacts.size(), 1u);
  EXPECT_EQ(result.contacts[0].a, "l3");
  EXPECT_EQ(result.contacts[0].b, "box 0");
  EXPECT_TRUE(result.contacts[0].with_scene);
  EXPECT_EQ(plan_motion(checker, vec({2.9, 0, 0}), {vec({1, 0, 0})}).outcome, Outcome::invalid_start);
}

/// Robots and recorded configurations are printed to five digits.
TEST(PlanMotion, EndsThatLostDigitsAreOnTheirLimits) {
  const test::PlanarArm arm(3, kLength);
  CollisionChecker checker(arm.group(), test::make_world({{{0.7, 0, 0}, {0.1, 0.1, 0.4}}}));
  const double limit = arm.group().upper()[0];
  const VectorXd start = vec({limit + 3e-6, 0.1, 0.1}), goal = vec({-limit - 3e-6, -0.1, -0.1});
  for (const std::string& planner : planner_names()) {
    MotionOptions options;
    options.planner = planner;
    options.max_iterations = 3000;
    const MotionResult result = plan_motion(checker, start, {goal}, options);
    ASSERT_EQ(result.outcome, Outcome::solved) << planner;
    EXPECT_EQ(result.path->waypoints.front(), start) << planner;
    EXPECT_EQ(result.path->waypoints.back(), goal) << planner;
  }
  const MotionResult beyond = plan_motion(checker, vec({limit + 3e-5, 0.1, 0.1}), {goal});
  EXPECT_EQ(beyond.outcome, Outcome::invalid_start);
  EXPECT_NE(beyond.beyond_limits.find("2.80003 is outside of its limits [-2.8, 2.8]"), std::string::npos)
      << beyond.beyond_limits;
}

TEST(PlanMotion, InvalidGoalsAreCountedByCause) {
  const test::PlanarArm arm(3, kLength);
  CollisionChecker checker(arm.group(), test::make_world({{{1.0, 0, 0}, {0.1, 0.1, 0.1}}}));
  const MotionResult result =
      plan_motion(checker, vec({1, 0, 0}), {vec({0, 0, 0}), vec({0.01, 0, 0}), vec({2.9, 0, 0})});
  EXPECT_EQ(result.outcome, Outcome::invalid_goal);
  EXPECT_FALSE(result.path);
  EXPECT_EQ(result.goal_index, -1);
  EXPECT_EQ(result.rejections.scene, 2u);
  EXPECT_EQ(result.rejections.limits, 1u);
  ASSERT_FALSE(result.contacts.empty());
  EXPECT_EQ(result.contacts[0].b, "box 0");
}

TEST(PlanMotion, NarrowPassage) {
  // Four links, 2 cm wide, thread a gap of 5 cm.
  const test::PlanarArm arm(4, kLength, 0.02);
  const std::vector<SceneBox> scene{{{1.0, 0.475, 0}, {0.05, 0.9, 0.2}}, {{1.0, -0.475, 0}, {0.05, 0.9, 0.2}}};
  CollisionChecker checker(arm.group(), test::make_world(scene));
  // Reaching through the gap, and standing in front of the wall.
  const VectorXd through = vec({0.0, 0.0, 0.0, 0.0}), before = vec({1.2, -1.6, -1.0, -1.2});
  ASSERT_TRUE(checker.is_free(through));
  ASSERT_TRUE(checker.is_free(before));
  for (unsigned seed = 1; seed <= 5; ++seed) {
    MotionOptions options;
    options.seed = seed;
    options.time_limit = 60;
    options.max_iterations = 200000;
    const MotionResult result = plan_motion(checker, before, {through}, options);
    ASSERT_EQ(result.outcome, Outcome::solved) << seed;
    EXPECT_GT(test::fcl_path_clearance(arm, kLength, *result.path, scene, MotionOptions{}.joint_step / 8), 0);
    EXPECT_LE(result.cost, result.stats.length_before_shortening + 1e-9);
  }
}

TEST(PlanMotion, RoadmapsLeaveNarrowEnds) {
  // The last of three links begins in a slot of 4 cm: hardly any vertex drawn anywhere sees that end.
  const test::PlanarArm arm(3, kLength, 0.02);
  const std::vector<SceneBox> slot{{{1.15, 0.07, 0}, {0.2, 0.1, 0.2}}, {{1.15, -0.07, 0}, {0.2, 0.1, 0.2}}};
  const VectorXd inside = vec({0.6, -1.2, 0.6}), outside = vec({1.8, -0.6, -0.6});
  for (const std::string planner : {"prm", "prm_star", "lazy_prm_star"}) {
    int solved = 0;
    for (unsigned seed = 1; seed <= 40; ++seed) {
      CollisionChecker checker(arm.group(), test::make_world(slot));
      MotionOptions options;
      options.planner = planner;
      options.seed = seed;
      options.time_limit = 60;
      options.max_iterations = 400;
      const MotionResult result = plan_motion(checker, inside, {outside}, options);
      if (result.outcome != Outcome::solved) continue;
      ++solved;
      EXPECT_GT(test::fcl_path_clearance(arm, kLength, *result.path, slot, options.joint_step / 8), 0);
    }
    EXPECT_EQ(solved, 40) << planner;
  }
}

TEST(PlanMotion, ThinObstaclesAreNotCut) {
  // A plate far thinner than what the links move within a coarse joint_step: the final check must catch what slips
  // through.
  const test::PlanarArm arm(2, kLength, 0.01);
  const std::vector<SceneBox> scene{{{0.65, 0, 0}, {0.2, 0.001, 0.2}}};
  int solved = 0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    CollisionChecker checker(arm.group(), test::make_world(scene));
    MotionOptions options;
    options.joint_step = 0.08;
    options.seed = seed;
    const MotionResult result = plan_motion(checker, vec({-0.5, 0.1}), {vec({0.5, -0.1})}, options);
    EXPECT_EQ(result.outcome == Outcome::solved, result.path.has_value());
    if (!result.path) continue;
    ++solved;
    // At ten times the resolution of the planner's final check the tip then moves less than the plate is thick.
    EXPECT_GT(test::fcl_path_clearance(arm, kLength, *result.path, scene, options.joint_step / 80), 0) << seed;
  }
  EXPECT_GE(solved, 15);
}

TEST(PlanMotion, ContinuousJointsCrossHalfATurn) {
  // The front is barred to the first link, so the only path from 2.4 to -2.4 leads over pi, past a plate that needs
  // folding.
  const test::PlanarArm arm(2, kLength, 0.02, true);
  const std::vector<SceneBox> scene{{{0.25, 0, 0}, {0.1, 0.1, 0.2}}, {{-0.7, 0, 0}, {0.3, 0.02, 0.2}}};
  CollisionChecker checker(arm.group(), test::make_world(scene));
  for (unsigned seed = 1; seed <= 10; ++seed) {
    MotionOptions options;
    options.seed = seed;
    const VectorXd start = vec({2.4, 0.1}), goal = vec({-2.4, -0.1});
    const MotionResult result = plan_motion(checker, start, {goal}, options);
    ASSERT_EQ(result.outcome, Outcome::solved) << seed;
    EXPECT_EQ(result.path->waypoints.front(), start);
    // The first joint went on upwards; how often the elbow turned is its own business.
    EXPECT_NEAR(result.path->waypoints.back()[0], goal[0] + 2 * M_PI, 1e-12);
    EXPECT_NEAR(std::remainder(result.path->waypoints.back()[1] - goal[1], 2 * M_PI), 0, 1e-12);
    EXPECT_GT(test::fcl_path_clearance(arm, kLength, *result.path, scene, MotionOptions{}.joint_step / 8), 0);
  }
}

TEST(PlanMotion, AStartBeyondOneTurnKeepsItsNumbers) {
  const test::PlanarArm arm(2, kLength, 0.02, true);
  CollisionChecker checker(arm.group(), World{});
  const MotionResult result = plan_motion(checker, vec({7.0, -4.0}), {vec({7.3 - 2 * M_PI, -4.1 + 4 * M_PI})});
  ASSERT_EQ(result.outcome, Outcome::solved);
  EXPECT_EQ(result.path->waypoints.front(), vec({7.0, -4.0}));
  EXPECT_LT((result.path->waypoints.back() - vec({7.3, -4.1})).norm(), 1e-12);
}

TEST(PlanMotion, WaitingForAnotherPlannerEndsByClockAndStop) {
  // The arm has to fold to pass the box.
  const test::PlanarArm arm(2, kLength);
  const World world = test::make_world({{{0.7, 0, 0}, {0.1, 0.1, 0.2}}});
  const VectorXd start = vec({-0.5, 0.1}), goal = vec({0.5, -0.1});
  const auto plan = [&](const std::string& planner, double time_limit, const Monitor& monitor) {
    CollisionChecker checker(arm.group(), world);
    MotionOptions options;
    options.planner = planner;
    options.time_limit = time_limit;
    options.max_iterations = 100000;
    return plan_motion(checker, start, {goal}, options, monitor).outcome;
  };
  // A planner that draws seeds for itself alone stands still within its search.
  std::promise<void> standing, go_on;
  std::atomic<bool> stands{false};
  std::thread holder([&] {
    CollisionChecker checker(arm.group(), world);
    MotionOptions options;
    options.planner = "rrt_star";
    options.max_iterations = 2000;
    options.time_limit = 100;
    options.on_improvement = [&, first = true](const Improvement&) mutable {
      if (!first) return;
      first = false;
      stands = true;
      standing.set_value();
      go_on.get_future().wait_for(std::chrono::seconds(30));  // A waiter that ends by nothing else fails then.
      stands = false;
    };
    EXPECT_EQ(plan_motion(checker, start, {goal}, options).outcome, Outcome::solved);
  });
  const bool begun = standing.get_future().wait_for(std::chrono::seconds(100)) == std::future_status::ready;
  EXPECT_TRUE(begun);
  for (const std::string planner : {"bi_est", "ompl_rrt_connect"}) {
    if (!begun) break;
    EXPECT_EQ(plan(planner, 0.05, {}), Outcome::timeout) << planner;
    Monitor monitor;
    std::thread stopper([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      monitor.stop.stop();
    });
    EXPECT_EQ(plan(planner, 100, monitor), Outcome::stopped) << planner;
    stopper.join();
    EXPECT_TRUE(stands) << planner << " waited for the other to end";
  }
  go_on.set_value();
  holder.join();
  for (const std::string planner : {"bi_est", "ompl_rrt_connect"})
    EXPECT_EQ(plan(planner, 100, {}), Outcome::solved) << planner;
}

/// Draws around the ends change what a roadmap planner finds, and nothing of a planner that grows trees.
TEST(PlanMotion, RoadmapsDrawAroundTheEndsAsOftenAsAsked) {
  const test::PlanarArm arm(3, kLength);
  CollisionChecker checker(arm.group(), test::make_world({{{0.7, 0, 0}, {0.1, 0.1, 0.2}}}));
  const auto path_of = [&](const std::string& planner, double probability) {
    MotionOptions options;
    options.planner = planner;
    options.near_end_probability = probability;
    options.max_iterations = 500;
    options.time_limit = 100;
    options.shorten = false;
    const MotionResult result = plan_motion(checker, vec({0.9, 0.2, 0.2}), {vec({-0.9, -0.2, -0.2})}, options);
    EXPECT_EQ(result.outcome, Outcome::solved) << planner << probability;
    return result.path ? result.path->waypoints : std::vector<VectorXd>{};
  };
  EXPECT_EQ(path_of("prm_star", 0.2), path_of("prm_star", MotionOptions{}.near_end_probability));
  EXPECT_NE(path_of("prm_star", 0), path_of("prm_star", 0.2));
  EXPECT_EQ(path_of("ompl_rrt_connect", 0), path_of("ompl_rrt_connect", 0.2));
}

TEST(PlanMotion, RefusesBadInput) {
  const test::PlanarArm arm(2, kLength);
  CollisionChecker checker(arm.group(), World{});
  const VectorXd q = vec({0, 0});
  EXPECT_THROW(plan_motion(checker, vec({0}), {q}), InvalidInput);
  EXPECT_THROW(plan_motion(checker, q, {}), InvalidInput);
  EXPECT_THROW(plan_motion(checker, q, {vec({0, std::nan("")})}), InvalidInput);
  MotionOptions options;
  options.planner = "rrtconnect";
  try {
    plan_motion(checker, q, {q}, options);
    FAIL() << "an unknown planner was taken";
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("rrt_connect"), std::string::npos);
  }
  options = {};
  options.max_iterations = 0;
  EXPECT_THROW(plan_motion(checker, q, {q}, options), InvalidInput);
  options = {};
  options.base_margin = -1;
  EXPECT_THROW(plan_motion(checker, q, {q}, options), InvalidInput);
  for (const double chance : {-0.1, 1.0, std::nan("")}) {
    options = {};
    options.near_end_probability = chance;
    EXPECT_THROW(plan_motion(checker, q, {q}, options), InvalidInput) << chance;
  }
  options = {};
  options.joint_step = 0;
  EXPECT_THROW(plan_motion(checker, q, {q}, options), InvalidInput);
  options = {};
  options.time_limit = std::nan("");
  EXPECT_THROW(plan_motion(checker, q, {q}, options), InvalidInput);
}

}  // namespace
}  // namespace mmgrasp
