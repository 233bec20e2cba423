// plan_manipulation() with angles that have no limits: both planners, start to finish.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "mmgrasp/plan/manipulation.hpp"
#include "mmgrasp/plan/motion.hpp"
#include "mmgrasp/robot/ik.hpp"
#include "support/around.hpp"
#include "support/exhaustive_transfer.hpp"
#include "support/planar_arm.hpp"

namespace mmgrasp {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

/// A small box that an arm of three links turns from one pose to another, all turned about the base by `angle`. The
/// first joint has no limits.
ManipulationProblem turned_transfer(const Vector3d& from, const Vector3d& to, double angle, World world = {}) {
  const test::PlanarArm arm(3, 0.4, 0.02, false, 2.8, 1);
  LinkShape box;
  box.shape = Box{{0.02, 0.02, 0.02}};
  const Pose turn = test::flat_pose(0, 0, angle);
  ManipulationProblem problem{
      arm.group(), std::move(world), {box}, turn * arm.group().fk(from), turn * arm.group().fk(to), {}};
  problem.grasps.push_back({Pose::Identity(), 0, 0});
  problem.touch_links = {"l1", "l2", "l3", "tip"};
  return problem;
}

ManipulationOptions options_of(const std::string& planner) {
  ManipulationOptions options;
  options.planner = planner;
  options.time_limit = 100;
  options.ik_solutions = 2;
  options.prm.roadmap.vertices = 500;
  options.prm.roadmap.neighbours = 12;
  options.rrt.max_iterations = 1500;
  return options;
}

/// The least distance between ends of any two arm configurations, the short way round.
double least_distance(const ManipulationProblem& problem) {
  double least = std::numeric_limits<double>::infinity();
  for (const VectorXd& a : solve_ik_all(problem.group, problem.T_world_start, 4))
    for (const VectorXd& b : solve_ik_all(problem.group, problem.T_world_goal, 4))
      least = std::min(least, test::distance_around(problem.group.wraps(), a, b));
  return least;
}

/// Runs on continuously and is free in small steps.
void expect_good(const ManipulationProblem& problem, const ManipulationResult& result) {
  ASSERT_EQ(result.outcome, Outcome::solved);
  const std::vector<VectorXd>& path = result.path->waypoints;
  EXPECT_NEAR(result.path->length() + problem.grasps[result.grasp_index].cost, result.cost, 1e-9);
  EXPECT_LE(result.lower_bound, result.cost + 1e-9);
  CollisionChecker checker(problem.group, test::carrying(problem, problem.grasps[result.grasp_index]));
  for (std::size_t i = 0; i + 1 < path.size(); ++i) EXPECT_TRUE(checker.edge_is_free(path[i], path[i + 1], 0.002)) << i;
  const Pose T_object_hand = problem.grasps[result.grasp_index].T_object_hand;
  EXPECT_LT((problem.group.fk(path.front()).matrix() - (problem.T_world_start * T_object_hand).matrix()).norm(), 1e-3);
  EXPECT_LT((problem.group.fk(path.back()).matrix() - (problem.T_world_goal * T_object_hand).matrix()).norm(), 1e-3);
}

class WrappingJoints : public ::testing::TestWithParam<std::string> {};

TEST_P(WrappingJoints, NoPathCostsLessThanTheBound) {
  const ManipulationProblem problem = turned_transfer({2.8, 0.3, 0.2}, {-2.8, 0.4, 0.1}, 0);
  const ManipulationResult result = plan_manipulation(problem, options_of(GetParam()));
  expect_good(problem, result);
  const double least = least_distance(problem);
  ASSERT_LT(least, 0.8);
  EXPECT_NEAR(result.cost, least, 1e-3);
  EXPECT_NEAR(result.stats.postures_bound, least, 1e-3);
  // Any planner's path, from each arm configuration at the start.
  CollisionChecker checker(problem.group, test::carrying(problem, problem.grasps.front()));
  MotionGoals goals;
  goals.tool_poses = {problem.T_world_goal};
  for (const VectorXd& start : solve_ik_all(problem.group, problem.T_world_start, 4)) {
    const MotionResult motion = plan_motion_to(checker, start, goals);
    ASSERT_EQ(motion.outcome, Outcome::solved);
    EXPECT_LE(result.stats.postures_bound, motion.cost + 1e-3);
    EXPECT_LE(result.cost, motion.cost + 1e-3);
  }
}

TEST_P(WrappingJoints, TurningEverythingChangesNothing) {
  const Vector3d from(0.4, 0.5, -0.6), to(-0.3, 0.9, 0.3);
  const double cost = plan_manipulation(turned_transfer(from, to, 0), options_of(GetParam())).cost;
  for (const double angle : {1.0, 2.9, M_PI, 3.3, 2 * M_PI, 11.0}) {
    const ManipulationProblem problem = turned_transfer(from, to, angle);
    const ManipulationResult result = plan_manipulation(problem, options_of(GetParam()));
    expect_good(problem, result);
    EXPECT_NEAR(result.cost, cost, 1e-3) << angle;
    EXPECT_NEAR(result.stats.postures_bound, cost, 1e-3) << angle;
  }
}

/// A post that the straight line runs into, at the seam or opposite of it.
TEST_P(WrappingJoints, TheSeamIsNoWall) {
  const Vector3d from(0.6, 0.1, 0.1), to(-0.6, -0.1, -0.1);
  std::vector<double> costs;
  for (const double angle : {0.0, M_PI, -2.8}) {
    World world;
    world.add("post", Shape(Box{{0.1, 0.1, 0.2}}), test::flat_pose(0, 0, angle) * test::flat_pose(1.0, 0, 0));
    const ManipulationProblem problem = turned_transfer(from, to, angle, world);
    const ManipulationResult result = plan_manipulation(problem, options_of(GetParam()));
    expect_good(problem, result);
    EXPECT_GT(result.cost, 1.1 * least_distance(problem));
    EXPECT_LE(result.stats.postures_bound, costs.empty() ? result.cost : costs.front());
    costs.push_back(result.cost);
    // Past the post, not all the way round.
    EXPECT_LT(result.cost, 4);
  }
  EXPECT_LT(*std::max_element(costs.begin(), costs.end()), 1.06 * *std::min_element(costs.begin(), costs.end()));
}

/// Two walls leave the way round the back only: a path of more than half a turn.
TEST_P(WrappingJoints, PathsMayGoTheLongWayRound) {
  World world;
  world.add("wall", Shape(Box{{2.4, 0.02, 0.4}}), test::flat_pose(1.25, 0, 0));
  const ManipulationProblem problem = turned_transfer({0.5, 0.1, 0.1}, {-0.5, -0.1, -0.1}, 0, world);
  const ManipulationResult result = plan_manipulation(problem, options_of(GetParam()));
  expect_good(problem, result);
  const std::vector<VectorXd>& path = result.path->waypoints;
  EXPECT_GT(std::abs(path.back()[0] - path.front()[0]), M_PI);
  EXPECT_GT(result.cost, M_PI);
  EXPECT_LT(result.cost, 2 * M_PI);
  EXPECT_LT(result.lower_bound, 1.6);
}

INSTANTIATE_TEST_SUITE_P(Planners, WrappingJoints, ::testing::Values("prm_star_mg", "rrt_star_mg"),
                         [](const auto& info) { return info.param; });

TEST(WrappingJoints, TheRoadmapsOptimumIsTheExhaustiveOne) {
  int across = 0;
  for (const double angle : {0.0, M_PI}) {
    World world;
    world.add("post", Shape(Box{{0.1, 0.1, 0.2}}), test::flat_pose(0, 0, angle) * test::flat_pose(1.0, 0, 0));
    const ManipulationProblem problem = turned_transfer({0.6, 0.1, 0.1}, {-0.6, -0.1, -0.1}, angle, world);
    ManipulationOptions options = options_of("prm_star_mg");
    options.prm.roadmap.vertices = 400;
    options.prm.roadmap.neighbours = 0;
    options.prm.roadmap.gamma = 5;
    options.prm.shorten = false;
    const Roadmap roadmap = Roadmap::build(problem.group, options.prm.roadmap);
    const double best = test::exhaustive_cost(problem, options, roadmap, 0);
    ASSERT_TRUE(std::isfinite(best));
    for (const int batch : {1, 0})
      for (const bool lazy : {false, true}) {
        options.prm.batch = batch;
        options.prm.lazy_grasps = lazy;
        const ManipulationResult result = plan_manipulation(problem, options, &roadmap);
        expect_good(problem, result);
        EXPECT_NEAR(result.cost, best, 1e-9);
        EXPECT_NEAR(result.stats.roadmap_bound, best, 1e-9);
        for (const VectorXd& q : result.path->waypoints) across += std::abs(q[0]) > M_PI;
      }
  }
  EXPECT_GT(across, 0);
}

/// A platform with a lift: the heading wraps, positions do not. The one configuration at each end follows from the
/// pose.
TEST(WrappingJoints, HeadingsOfAnOmniBaseDoToo) {
  RobotOptions base;
  base.base = BaseKind::omni;
  base.base_limits.workspace = 3;
  const Robot robot = Robot::from_strings(
      "<robot name=\"platform\"><link name=\"base\"><collision><geometry><box size=\"0.1 0.1 0.1\"/></geometry>"
      "</collision></link><link name=\"slide\"/><link name=\"tip\"/>"
      "<joint name=\"lift\" type=\"prismatic\"><parent link=\"base\"/><child link=\"slide\"/><axis xyz=\"0 0 1\"/>"
      "<limit effort=\"1\" velocity=\"1\" lower=\"0\" upper=\"0.5\"/></joint>"
      "<joint name=\"mount\" type=\"fixed\"><parent link=\"slide\"/><child link=\"tip\"/>"
      "<origin xyz=\"0.3 0 0.3\"/></joint></robot>",
      "", base);
  LinkShape box;
  box.shape = Box{{0.02, 0.02, 0.02}};
  const JointGroup group = robot.chain("base", "tip", true);
  const Eigen::Vector4d from(0.2, -0.3, 2.7, 0.1), to(0.5, 0.1, -2.9, 0.4);
  const double expected = test::distance_around({false, false, true, false}, from, to);
  ASSERT_LT(expected, 1);
  for (const char* planner : {"prm_star_mg", "rrt_star_mg"})
    for (const double turns : {0.0, 2 * M_PI, -4 * M_PI}) {
      Eigen::Vector4d turned = to;
      turned[2] += turns;
      ManipulationProblem problem{group, {}, {box}, group.fk(from), group.fk(turned), {}};
      problem.grasps.push_back({Pose::Identity(), 0, 0});
      problem.touch_links = {"base", "slide", "tip"};
      const ManipulationResult result = plan_manipulation(problem, options_of(planner));
      expect_good(problem, result);
      EXPECT_NEAR(result.cost, expected, 1e-3) << planner << turns;
      EXPECT_NEAR(result.stats.postures_bound, expected, 1e-3) << planner << turns;
    }
}

}  // namespace
}  // namespace mmgrasp
