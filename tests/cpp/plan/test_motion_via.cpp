// plan_motion_via: motions by way of given configurations.
#include <gtest/gtest.h>

#include <algorithm>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/plan/motion.hpp"
#include "support/fcl_planar.hpp"
#include "support/planar_arm.hpp"
#include "support/vec.hpp"

namespace mmgrasp {
namespace {

using Eigen::VectorXd;
using test::vec;

constexpr double kLength = 0.4;

MotionGoals to(const VectorXd& q) {
  MotionGoals goals;
  goals.configurations = {q};
  return goals;
}

TEST(PlanMotionVia, PassesThemInTurn) {
  const test::PlanarArm arm(3, kLength);
  CollisionChecker checker(arm.group(), test::make_world({{{0.9, 0, 0}, {0.1, 0.3, 0.1}}}));
  const VectorXd start = vec({-0.8, 0, 0}), goal = vec({0.8, 0, 0});
  const std::vector<VectorXd> via{vec({-1.5, 1, 1}), vec({0.2, 2, 2})};
  int reported = 0;
  MotionOptions options;
  options.on_improvement = [&](const Improvement& whole) {
    ++reported;
    EXPECT_EQ(whole.path.waypoints.back(), goal);
  };
  const MotionResult result = plan_motion_via(checker, start, via, to(goal), options);
  ASSERT_EQ(result.outcome, Outcome::solved);
  EXPECT_EQ(result.via_reached, 2);
  EXPECT_EQ(reported, 1);
  const std::vector<VectorXd>& path = result.path->waypoints;
  EXPECT_EQ(path.front(), start);
  EXPECT_EQ(path.back(), goal);
  const auto first = std::find(path.begin(), path.end(), via[0]);
  ASSERT_NE(first, path.end());
  EXPECT_NE(std::find(first, path.end(), via[1]), path.end());
  EXPECT_NEAR(result.cost, result.path->length(), 1e-12);
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    EXPECT_GT((path[i + 1] - path[i]).norm(), 0) << "the joints appear twice";
    EXPECT_TRUE(checker.edge_is_free(path[i], path[i + 1], 0.0025));
  }
  const MotionResult again = plan_motion_via(checker, start, via, to(goal));
  EXPECT_EQ(again.path->waypoints, path);
  const MotionResult direct = plan_motion_via(checker, start, {}, to(goal));
  EXPECT_EQ(direct.path->waypoints, plan_motion(checker, start, {goal}).path->waypoints);
}

TEST(PlanMotionVia, SaysWhichCannotBeReached) {
  const test::PlanarArm arm(3, kLength);
  CollisionChecker checker(arm.group(), test::make_world({{{1.0, 0, 0}, {0.1, 0.1, 0.1}}}));
  const VectorXd start = vec({-0.8, 0, 0}), goal = vec({0.8, 0, 0});
  const MotionResult result = plan_motion_via(checker, start, {vec({-1, 0, 0}), vec({0, 0, 0})}, to(goal));
  EXPECT_EQ(result.outcome, Outcome::invalid_goal);
  EXPECT_EQ(result.via_reached, 1);
  EXPECT_FALSE(result.path);
  ASSERT_EQ(result.contacts.size(), 1u);
  EXPECT_EQ(result.contacts[0].b, "box 0");
  EXPECT_THROW(plan_motion_via(checker, start, {vec({0, 0})}, to(goal)), InvalidInput);
  EXPECT_THROW(plan_motion_via(checker, start, {vec({0, 0, 0})}, {}), InvalidInput);
}

}  // namespace
}  // namespace mmgrasp
