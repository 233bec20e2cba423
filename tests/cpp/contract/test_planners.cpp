// What every planner of planner_names() promises.
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <limits>
#include <set>
#include <thread>
#include <utility>
#include <vector>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/plan/motion.hpp"
#include "support/fcl_planar.hpp"
#include "support/planar_arm.hpp"

namespace mmgrasp {
namespace {

using Eigen::VectorXd;
using test::SceneBox;

constexpr double kLength = 0.4;

VectorXd vec(double a, double b, double c) {
  return Eigen::Vector3d(a, b, c);
}

/// Three links that must fold to pass a wall in front of the base.
class Planner : public ::testing::TestWithParam<std::string> {
 protected:
  const test::PlanarArm arm{3, kLength};
  const std::vector<SceneBox> wall{{{1.0, 0, 0}, {0.7, 0.1, 0.2}}};
  // The first link cannot leave the sector between two posts.
  const std::vector<SceneBox> posts{{{0.25, 0.25, 0}, {0.05, 0.05, 0.2}}, {{0.25, -0.25, 0}, {0.05, 0.05, 0.2}}};
  const VectorXd start = vec(-1.0, 0.2, 0.2), goal = vec(1.0, -0.2, -0.2);

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  void SetUp() override {
    const std::set<std::string> informed{"informed_rrt_star", "bit_star", "abit_star", "ait_star"};
    if (informed.count(GetParam())) {
      GTEST_SKIP() << "Sanitizers refuse RTLD_DEEPBIND, without which OMPL's ellipsoids run into KDL's Eigen";
    }
  }
#endif

  MotionOptions options() const {
    MotionOptions options;
    options.planner = GetParam();
    // Those that improve on their first path spend all of it; roadmaps grow slower than trees.
    const std::set<std::string> roadmaps{"prm_star", "lazy_prm_star"}, trees{"rrt_star", "informed_rrt_star"};
    options.max_iterations = roadmaps.count(GetParam()) ? 800 : trees.count(GetParam()) ? 2000 : 5000;
    options.time_limit = 100;  // Not to end a run: the iterations do.
    options.seed = 3;
    return options;
  }

  CollisionChecker checker(const std::vector<SceneBox>& scene) const {
    return CollisionChecker(arm.group(), test::make_world(scene));
  }

  void expect_sound(const MotionResult& result, const VectorXd& from, const VectorXd& to,
                    const std::vector<SceneBox>& scene) const {
    ASSERT_TRUE(result.path);
    EXPECT_EQ(result.path->waypoints.front(), from);
    EXPECT_EQ(result.path->waypoints.back(), to);
    EXPECT_NEAR(result.cost, result.path->length(), 1e-12);
    EXPECT_GE(result.cost, (to - from).norm() - 1e-12);
    for (const auto& q : result.path->waypoints) EXPECT_TRUE(arm.group().within_limits(q));
    expect_free(arm, *result.path, scene);
  }

  /// At the promised resolution nothing touches; at a far higher one nothing enters by more than a corner can between
  /// two checks.
  void expect_free(const test::PlanarArm& arm, const JointPath& path, const std::vector<SceneBox>& scene) const {
    EXPECT_GT(test::fcl_path_clearance(arm, kLength, path, scene, MotionOptions{}.joint_step / 8), 0);
    std::vector<SceneBox> core = scene;
    for (auto& box : core) box.size.array() -= 1e-3;
    EXPECT_GT(test::fcl_path_clearance(arm, kLength, path, core, 3e-4), 0);
  }
};

TEST_P(Planner, SolvesAndThePathIsFreeByFcl) {
  CollisionChecker checker = this->checker(wall);
  ASSERT_FALSE(checker.edge_is_free(start, goal));
  const MotionResult result = plan_motion(checker, start, {goal}, options());
  ASSERT_EQ(result.outcome, Outcome::solved);
  EXPECT_EQ(result.goal_index, 0);
  EXPECT_GT(result.stats.collision_queries, 0u);
  EXPECT_GE(result.stats.length_before_shortening, result.cost - 1e-9);
  expect_sound(result, start, goal, wall);
}

TEST_P(Planner, SolvesWithoutShortening) {
  CollisionChecker checker = this->checker(wall);
  MotionOptions options = this->options();
  options.shorten = false;
  const MotionResult result = plan_motion(checker, start, {goal}, options);
  ASSERT_EQ(result.outcome, Outcome::solved);
  expect_sound(result, start, goal, wall);
  EXPECT_NEAR(result.stats.length_before_shortening, result.cost, 1e-12);
}

TEST_P(Planner, SameSeedSamePathAlsoFromManyThreads) {
  const auto plan = [&] {
    CollisionChecker checker = this->checker(wall);
    return plan_motion(checker, start, {goal}, options());
  };
  const MotionResult expected = plan();
  ASSERT_TRUE(expected.path);
  std::vector<MotionResult> results(3);
  results[0] = plan();
  std::vector<std::thread> threads;
  for (std::size_t i = 1; i < results.size(); ++i) threads.emplace_back([&, i] { results[i] = plan(); });
  for (auto& thread : threads) thread.join();
  for (const auto& result : results) {
    ASSERT_TRUE(result.path);
    EXPECT_EQ(result.path->waypoints, expected.path->waypoints);
    EXPECT_EQ(result.stats.collision_queries, expected.stats.collision_queries);
  }
}

TEST_P(Planner, AnotherSeedGivesAnotherPath) {
  CollisionChecker checker = this->checker(wall);
  MotionOptions options = this->options();
  options.shorten = false;
  const MotionResult first = plan_motion(checker, start, {goal}, options);
  options.seed = 4;
  const MotionResult second = plan_motion(checker, start, {goal}, options);
  ASSERT_TRUE(first.path && second.path);
  EXPECT_NE(first.path->waypoints, second.path->waypoints);
}

TEST_P(Planner, ReportsBetterAndBetterPaths) {
  CollisionChecker checker = this->checker(wall);
  MotionOptions options = this->options();
  std::vector<std::pair<JointPath, double>> reported;
  options.on_improvement = [&](const Improvement& better) { reported.emplace_back(better.path, better.cost); };
  const MotionResult result = plan_motion(checker, start, {goal}, options);
  ASSERT_EQ(result.outcome, Outcome::solved);
  ASSERT_FALSE(reported.empty());
  double best = std::numeric_limits<double>::infinity();
  for (const auto& [path, cost] : reported) {
    EXPECT_LT(cost, best);
    best = cost;
    EXPECT_NEAR(cost, path.length(), 1e-9);
    EXPECT_EQ(path.waypoints.front(), start);
    EXPECT_EQ(path.waypoints.back(), goal);
    EXPECT_GT(test::fcl_path_clearance(arm, kLength, path, wall, options.joint_step / 8), 0);
  }
  EXPECT_LE(best, result.cost + 1e-12);
  // Listening changes nothing.
  options.on_improvement = {};
  CollisionChecker fresh = this->checker(wall);
  EXPECT_EQ(plan_motion(fresh, start, {goal}, options).path->waypoints, result.path->waypoints);
}

TEST_P(Planner, PathsOfPlannersThatKeepImprovingPassTheFinalCheck) {
  const std::set<std::string> improving{"prm_star", "lazy_prm_star", "rrt_star", "informed_rrt_star",
                                        "bit_star", "abit_star",     "ait_star"};
  // The shortest path leads past the end of a plate that is thinner than what the tip moves within a step. Between two
  // of the final checks it moves 8 mm and may enter by half of that.
  const test::PlanarArm thin(2, kLength, 0.01);
  const std::vector<SceneBox> plate{{{0.65, 0, 0}, {0.2, 0.02, 0.2}}}, core{{{0.65, 0, 0}, {0.192, 0.012, 0.2}}};
  VectorXd from(2), to(2);
  from << -0.5, 0.1;
  to << 0.5, -0.1;
  for (unsigned seed = 1; seed <= 3; ++seed) {
    CollisionChecker checker(thin.group(), test::make_world(plate));
    MotionOptions options = this->options();
    options.joint_step = 0.08;
    options.seed = seed;
    options.on_improvement = [&](const Improvement& better) {
      EXPECT_GT(test::fcl_path_clearance(thin, kLength, better.path, core, options.joint_step / 80), 0);
    };
    // There is time for one search only when the time limit ends it.
    int searches = 0;
    Monitor monitor;
    monitor.progress = [&](const std::string&, double share) { searches += share > 0 && share < 1; };
    const MotionResult result = plan_motion(checker, from, {to}, options, monitor);
    ASSERT_EQ(result.outcome, Outcome::solved);
    if (improving.count(GetParam())) {
      EXPECT_EQ(searches, 1);
    }
  }
}

TEST_P(Planner, FreeSpaceIsCrossedStraightAndTheGoalMayBeTheStart) {
  CollisionChecker checker = this->checker({});
  const MotionResult straight = plan_motion(checker, start, {goal}, options());
  ASSERT_EQ(straight.outcome, Outcome::solved);
  EXPECT_EQ(straight.path->waypoints, (std::vector<VectorXd>{start, goal}));
  const MotionResult nowhere = plan_motion(checker, start, {start}, options());
  ASSERT_EQ(nowhere.outcome, Outcome::solved);
  EXPECT_EQ(nowhere.cost, 0);
}

TEST_P(Planner, AnInvalidStartNamesThePair) {
  CollisionChecker checker = this->checker(wall);
  const MotionResult result = plan_motion(checker, vec(0, 0, 0), {goal}, options());
  EXPECT_EQ(result.outcome, Outcome::invalid_start);
  ASSERT_FALSE(result.contacts.empty());
  EXPECT_EQ(result.contacts[0].b, "box 0");
  EXPECT_TRUE(result.contacts[0].with_scene);
}

TEST_P(Planner, AnImpossibleGoalEndsByTheBudget) {
  CollisionChecker checker = this->checker(posts);
  MotionOptions options = this->options();
  options.max_iterations = 300;
  const MotionResult result = plan_motion(checker, vec(2.0, 0, 0), {vec(0, 0, 0)}, options);
  EXPECT_TRUE(result.outcome == Outcome::timeout || result.outcome == Outcome::not_found);
  EXPECT_FALSE(result.path);
  const MotionResult again = plan_motion(checker, vec(2.0, 0, 0), {vec(0, 0, 0)}, options);
  EXPECT_EQ(again.stats.collision_queries, result.stats.collision_queries);
}

TEST_P(Planner, TheCancelTokenEndsIt) {
  CollisionChecker checker = this->checker(posts);
  MotionOptions options = this->options();
  options.max_iterations = 2000000000;
  Monitor monitor;
  std::thread stopper([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    monitor.stop.stop();
  });
  const MotionResult result = plan_motion(checker, vec(2.0, 0, 0), {vec(0, 0, 0)}, options, monitor);
  stopper.join();
  EXPECT_EQ(result.outcome, Outcome::stopped);
  EXPECT_FALSE(result.path);
}

TEST_P(Planner, TheClockIsACap) {
  CollisionChecker checker = this->checker(posts);
  MotionOptions options = this->options();
  options.max_iterations = 2000000000;
  options.time_limit = 0.05;
  const MotionResult result = plan_motion(checker, vec(2.0, 0, 0), {vec(0, 0, 0)}, options);
  EXPECT_EQ(result.outcome, Outcome::timeout);
  EXPECT_FALSE(result.path);
}

TEST_P(Planner, TakesTheGoalItCanReach) {
  CollisionChecker checker = this->checker(posts);
  const VectorXd blocked = vec(0.785, 0, 0), inside = vec(0, 0, 0), outside = vec(-2.0, 0.4, 0);
  ASSERT_FALSE(checker.is_free(blocked));
  const VectorXd from = vec(2.0, 0, 0);
  // The posts leave no path across the front, nor one around: only `near` is on the same side.
  const VectorXd near = vec(1.6, 1.2, -1.5);
  const MotionResult result = plan_motion(checker, from, {blocked, inside, near, outside}, options());
  ASSERT_EQ(result.outcome, Outcome::solved);
  EXPECT_EQ(result.goal_index, 2);
  EXPECT_EQ(result.rejections.scene, 1u);
  EXPECT_EQ(result.rejections.total(), 1u);
  expect_sound(result, from, near, posts);
}

TEST_P(Planner, ContinuousJointsRunOnPastHalfATurn) {
  // A plate at half a turn blocks the straight edge.
  const test::PlanarArm round(2, kLength, 0.02, true);
  const std::vector<SceneBox> scene{{{-0.75, 0, 0}, {0.2, 0.02, 0.2}}};
  CollisionChecker checker(round.group(), test::make_world(scene));
  VectorXd from(2), to(2);
  from << 2.9, 0.1;
  to << -2.9, -0.1;
  ASSERT_TRUE(checker.is_free(from));
  ASSERT_TRUE(checker.is_free(to));
  const MotionResult result = plan_motion(checker, from, {to}, options());
  ASSERT_EQ(result.outcome, Outcome::solved);
  EXPECT_EQ(result.path->waypoints.front(), from);
  const VectorXd off = result.path->waypoints.back() - to;
  for (Eigen::Index i = 0; i < 2; ++i) EXPECT_NEAR(std::remainder(off[i], 2 * M_PI), 0, 1e-12);
  expect_free(round, *result.path, scene);
}

INSTANTIATE_TEST_SUITE_P(All, Planner, ::testing::ValuesIn(planner_names()),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace mmgrasp
