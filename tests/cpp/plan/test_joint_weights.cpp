// Weights of joints in the costs of paths: plan_motion and both planners over many grasps, start to finish.
#include "mmgrasp/robot/joint_weights.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/plan/manipulation.hpp"
#include "mmgrasp/plan/motion.hpp"
#include "mmgrasp/robot/ik.hpp"
#include "support/around.hpp"
#include "support/bar_transfer.hpp"
#include "support/gantry_walls.hpp"

namespace mmgrasp {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

/// Weighted length, written out by hand.
double length_of(const std::vector<VectorXd>& path, const VectorXd& weights) {
  double sum = 0;
  for (std::size_t w = 1; w < path.size(); ++w) {
    double squared = 0;
    for (Eigen::Index i = 0; i < weights.size(); ++i)
      squared += std::pow(weights[i] * (path[w][i] - path[w - 1][i]), 2);
    sum += std::sqrt(squared);
  }
  return sum;
}

bool same(const std::vector<VectorXd>& a, const std::vector<VectorXd>& b) {
  return a == b;
}

/// A post in the way of an arm of three links; the first `continuous` joints have no limits.
struct ArmPastPost {
  explicit ArmPastPost(int continuous) : arm(3, 0.4, 0.02, false, 2.8, continuous) {
    world.add("post", Shape(Box{{0.1, 0.1, 0.2}}), test::flat_pose(1.0, 0, 0));
  }
  test::PlanarArm arm;
  World world;
  Vector3d start{0.6, 0.1, 0.1}, goal{-0.6, -0.1, -0.1};
};

class MotionWeights : public ::testing::TestWithParam<std::string> {};

TEST_P(MotionWeights, CostIsTheWeightedLength) {
  for (const int continuous : {0, 1}) {
    const ArmPastPost scene(continuous);
    CollisionChecker checker(scene.arm.group(), scene.world);
    for (const Vector3d& weights : {Vector3d(5, 1, 0.3), Vector3d(0.2, 2, 3)}) {
      MotionOptions options;
      options.planner = GetParam();
      options.max_iterations = 6000;
      options.time_limit = 100;
      options.joint_weights = VectorXd(weights);
      const MotionResult result = plan_motion(checker, scene.start, {scene.goal}, options);
      ASSERT_EQ(result.outcome, Outcome::solved) << GetParam();
      EXPECT_NEAR(result.cost, length_of(result.path->waypoints, weights), 1e-9 * result.cost);
      EXPECT_GE(result.cost, (scene.goal - scene.start).cwiseProduct(weights).norm());
      EXPECT_NEAR((result.path->waypoints.front() - scene.start).norm(), 0, 1e-12);
      // Up to a whole turn.
      EXPECT_NEAR(test::distance_around(scene.arm.group().wraps(), result.path->waypoints.back(), scene.goal), 0,
                  1e-12);
      if (GetParam() == "rrt_connect") continue;
      // Weights matter: a planner that keeps improving beats the path that is best without them.
      options.joint_weights = {};
      const MotionResult plain = plan_motion(checker, scene.start, {scene.goal}, options);
      ASSERT_EQ(plain.outcome, Outcome::solved);
      EXPECT_LT(result.cost, length_of(plain.path->waypoints, weights));
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Planners, MotionWeights,
                         ::testing::Values("rrt_connect", "rrt_star", "informed_rrt_star", "prm_star", "bit_star"),
                         [](const auto& info) { return info.param; });

TEST(MotionWeights, AllByTheSameFactorChangeNothing) {
  for (const int continuous : {0, 1}) {
    const ArmPastPost scene(continuous);
    CollisionChecker checker(scene.arm.group(), scene.world);
    for (const bool even : {true, false})
      for (unsigned seed = 1; seed <= 5; ++seed) {
        const VectorXd weights = even ? Vector3d(1, 1, 1) : Vector3d(5, 1, 0.3);
        MotionOptions options;
        options.seed = seed;
        options.joint_weights = weights;
        const MotionResult result = plan_motion(checker, scene.start, {scene.goal}, options);
        ASSERT_EQ(result.outcome, Outcome::solved);
        for (const double factor : {0.125, 2.0, 1024.0}) {
          options.joint_weights = VectorXd(factor * weights);
          const MotionResult scaled = plan_motion(checker, scene.start, {scene.goal}, options);
          ASSERT_EQ(scaled.outcome, Outcome::solved);
          EXPECT_TRUE(same(scaled.path->waypoints, result.path->waypoints)) << factor;
          EXPECT_EQ(scaled.cost, factor * result.cost);
          EXPECT_EQ(scaled.stats.length_before_shortening, factor * result.stats.length_before_shortening);
          EXPECT_EQ(scaled.stats.collision_queries, result.stats.collision_queries);
        }
      }
  }
}

/// The nearer goal by the weights is taken: to drive a metre or to turn a joint by 1.5 rad.
TEST(MotionWeights, DecideBetweenBaseAndArm) {
  RobotOptions omni;
  omni.base = BaseKind::omni;
  const JointGroup group =
      Robot::from_strings(
          "<robot name='r'><link name='base'/><link name='arm'/><joint name='turn' type='revolute'>"
          "<parent link='base'/><child link='arm'/><axis xyz='0 1 0'/><limit lower='-2' upper='2' "
          "velocity='1' effort='1'/></joint></robot>",
          "", omni)
          .chain("base", "arm", true);
  CollisionChecker checker(group, World());
  const VectorXd start = VectorXd::Zero(4);
  VectorXd drive = start, turn = start;
  drive[0] = 1;
  turn[3] = 1.5;
  for (const double metre : {0.5, 1.0, 1.49, 1.51, 10.0}) {
    MotionOptions options;
    options.joint_weights = {{group.names()[0], metre}};
    const MotionResult result = plan_motion(checker, start, {turn, drive}, options);
    ASSERT_EQ(result.outcome, Outcome::solved);
    EXPECT_EQ(result.goal_index, metre < 1.5 ? 1 : 0);
    EXPECT_NEAR(result.cost, std::min(metre, 1.5), 1e-12);
  }
}

TEST(MotionWeights, BadOnesAreRefused) {
  const ArmPastPost scene(0);
  CollisionChecker checker(scene.arm.group(), scene.world);
  MotionOptions options;
  options.joint_weights = VectorXd(Vector3d(1, 0, 1));
  EXPECT_THROW(plan_motion(checker, scene.start, {scene.goal}, options), InvalidInput);
  ManipulationOptions manipulation;
  manipulation.joint_weights = {{"j9", 2}};
  EXPECT_THROW(plan_manipulation(test::bar_transfer(), manipulation), InvalidInput);
  manipulation.joint_weights = {};
  manipulation.prm.roadmap.joint_weights = {{"j1", 2}};
  EXPECT_THROW(plan_manipulation(test::bar_transfer(), manipulation), InvalidInput);
  // A roadmap measures edges by the weights it was built with.
  const ManipulationProblem problem = test::bar_transfer();
  RoadmapOptions with_weights;
  with_weights.vertices = 50;
  with_weights.joint_weights = {{"j1", 2}};
  const Roadmap roadmap = Roadmap::build(problem.group, with_weights);
  try {
    plan_manipulation(problem, {}, &roadmap);
    ADD_FAILURE();
  } catch (const InvalidInput& error) {
    EXPECT_STREQ(error.what(), "roadmap: was built with joint_weights 2, 1, 1, not with all joint_weights 1");
  }
}

ManipulationOptions options_of(const std::string& planner) {
  ManipulationOptions options;
  options.planner = planner;
  options.time_limit = 1000;
  options.ik_solutions = 2;
  options.prm.roadmap.vertices = 500;
  options.rrt.max_iterations = 1000;
  return options;
}

/// bar_transfer() or, with a first joint that has no limits, a box moved past a post.
ManipulationProblem transfer(bool wraps) {
  if (!wraps) return test::bar_transfer();
  const ArmPastPost scene(1);
  LinkShape box;
  box.shape = Box{{0.02, 0.02, 0.02}};
  ManipulationProblem problem{
      scene.arm.group(), scene.world, {box}, scene.arm.group().fk(scene.start), scene.arm.group().fk(scene.goal), {}};
  problem.grasps.push_back({Pose::Identity(), 0, 0});
  problem.touch_links = {"l1", "l2", "l3", "tip"};
  return problem;
}

class TransferWeights : public ::testing::TestWithParam<std::string> {};

TEST_P(TransferWeights, CostIsTheWeightedLengthAndNoPlannerGoesBelowTheBound) {
  for (const bool wraps : {false, true}) {
    const ManipulationProblem problem = transfer(wraps);
    for (const Vector3d& weights : {Vector3d(4, 1, 0.5), Vector3d(0.3, 1, 2)}) {
      ManipulationOptions options = options_of(GetParam());
      options.joint_weights = VectorXd(weights);
      const ManipulationResult result = plan_manipulation(problem, options);
      ASSERT_EQ(result.outcome, Outcome::solved);
      const Grasp& grasp = problem.grasps[result.grasp_index];
      EXPECT_NEAR(result.cost, length_of(result.path->waypoints, weights) + grasp.cost, 1e-9 * result.cost);
      for (const Improvement& each : result.improvements)
        EXPECT_NEAR(each.cost, length_of(each.path.waypoints, weights) + problem.grasps[each.grasp].cost, 1e-6);
      EXPECT_LE(result.lower_bound, result.stats.postures_bound);
      // The bounds are the least straight lines between postures, by hand.
      double least = 1e9;
      for (const Grasp& own : problem.grasps) {
        CollisionChecker checker(problem.group, test::carrying(problem, own));
        const auto free = [&](const VectorXd& q) { return checker.rejection(q); };
        const std::vector<VectorXd> starts =
            solve_ik_all(problem.group, problem.T_world_start * own.T_object_hand, 8, {}, free);
        const std::vector<VectorXd> goals =
            solve_ik_all(problem.group, problem.T_world_goal * own.T_object_hand, 8, {}, free);
        for (const VectorXd& a : starts)
          for (const VectorXd& b : goals)
            least = std::min(least, own.cost + test::distance_around(problem.group.wraps(), a, b, weights));
        // Any planner's path.
        MotionOptions motion;
        motion.joint_weights = VectorXd(weights);
        for (const VectorXd& start : starts) {
          if (goals.empty()) continue;
          const MotionResult found = plan_motion(checker, start, goals, motion);
          if (!found.path) continue;
          EXPECT_LE(result.lower_bound, found.cost + own.cost + 1e-6);
        }
      }
      EXPECT_NEAR(result.stats.postures_bound, least, 1e-3 * least);
    }
  }
}

TEST_P(TransferWeights, AllByTheSameFactorChangeNothing) {
  for (const bool wraps : {false, true})
    for (const bool even : {true, false}) {
      const ManipulationProblem problem = transfer(wraps);
      const VectorXd weights = even ? Vector3d(1, 1, 1) : Vector3d(4, 1, 0.5);
      ManipulationOptions options = options_of(GetParam());
      options.joint_weights = weights;
      const ManipulationResult result = plan_manipulation(problem, options);
      ASSERT_EQ(result.outcome, Outcome::solved);
      for (const double factor : {0.5, 4.0}) {
        options.joint_weights = VectorXd(factor * weights);
        const ManipulationResult scaled = plan_manipulation(problem, options);
        ASSERT_EQ(scaled.outcome, Outcome::solved);
        EXPECT_EQ(scaled.grasp_index, result.grasp_index);
        EXPECT_TRUE(same(scaled.path->waypoints, result.path->waypoints)) << wraps << even << factor;
        EXPECT_EQ(scaled.cost, factor * result.cost);
        EXPECT_EQ(scaled.lower_bound, factor * result.lower_bound);
        EXPECT_EQ(scaled.stats.postures_bound, factor * result.stats.postures_bound);
        EXPECT_EQ(scaled.stats.edges_checked_attached, result.stats.edges_checked_attached);
        EXPECT_EQ(scaled.improvements.size(), result.improvements.size());
      }
    }
}

/// An omni base with a lift carries a ball past a wall, beside it or above it: the cheaper way by the weights, at the
/// cost that its corners give.
TEST_P(TransferWeights, DecideWhetherToDriveRoundOrToLift) {
  RobotOptions omni;
  omni.base = BaseKind::omni;
  omni.base_limits.workspace = 4;
  const double r = 0.02, beside = 0.4, above = 0.6, half = 0.05;
  const Robot robot = Robot::from_strings(
      "<robot name='platform'><link name='base'/><link name='hand'><collision><geometry><sphere radius='0.02'/>"
      "</geometry></collision></link><joint name='lift' type='prismatic'><parent link='base'/><child link='hand'/>"
      "<axis xyz='0 0 1'/><limit lower='0' upper='1.5' velocity='1' effort='1'/></joint></robot>",
      "", omni);
  const JointGroup group = robot.chain("base", "hand", true);
  const Eigen::Vector4d start(0, 0, 0, 0.05), goal(2, 0, 0, 0.05);
  LinkShape ball;
  ball.shape = Sphere{0.5 * r};
  World world;
  Pose T = Pose::Identity();
  T.translation() << 1, 0.5 * (beside - 4), 0.5 * (above - 1);
  world.add("wall", Shape(Box{{2 * half, beside + 4, above + 1}}), T);
  ManipulationProblem problem{group, world, {ball}, group.fk(start), group.fk(goal), {Grasp{Pose::Identity(), 0, 0}}};
  problem.touch_links = {"base", "hand"};
  // Past an edge of the wall `away` from the straight line, whose metre costs `metre`.
  const auto past = [&](double along, double away, double metre) {
    return 2 * std::hypot(along * (1 - half), metre * away) + along * 2 * half;
  };
  for (const Eigen::Vector4d& weights :
       {Eigen::Vector4d(1, 1, 1, 1), Eigen::Vector4d(1, 1, 1, 4), Eigen::Vector4d(2, 4, 1, 1)}) {
    ManipulationOptions options = options_of(GetParam());
    options.ik_solutions = 1;
    options.rrt.max_iterations = 3000;
    options.joint_weights = VectorXd(weights);
    const ManipulationResult result = plan_manipulation(problem, options);
    ASSERT_EQ(result.outcome, Outcome::solved);
    const double drive = past(weights[0], beside + r, weights[1]),
                 lift = past(weights[0], above - 0.05 + r, weights[3]);
    const double expected = std::min(drive, lift);
    EXPECT_GT(result.cost, expected * (1 - r));  // The ball goes round the wall's edges, not their corner.
    EXPECT_LT(result.cost, 1.04 * expected);
    double most_y = 0, most_z = 0;
    for (const VectorXd& q : result.path->waypoints) {
      most_y = std::max(most_y, q[1]);
      most_z = std::max(most_z, q[3]);
    }
    EXPECT_GT(drive < lift ? most_y - beside : most_z - above, 0);
    EXPECT_GT(std::abs(drive / lift - 1), 0.04);
    EXPECT_NEAR(result.stats.postures_bound, 2 * weights[0], 1e-3);
  }
}

/// Six joints past a wall with a door, against the exact optimum in weighted coordinates.
TEST_P(TransferWeights, ReachTheExactOptimum) {
  VectorXd weights(6);
  weights << 3, 1, 0.7, 0.5, 0.4, 0.6;
  const test::GantryWalls scene = test::gantry_walls_problem(test::wall_with_door(0.08), true, weights);
  ManipulationOptions options = options_of(GetParam());
  options.joint_weights = weights;
  options.rrt.max_iterations = 4000;
  const ManipulationResult result = plan_manipulation(scene.problem, options);
  ASSERT_EQ(result.outcome, Outcome::solved);
  EXPECT_GT(result.cost, scene.optimum * (1 - 1e-4));  // Between two steps of its check a path may cut a corner.
  EXPECT_LT(result.cost, scene.optimum * (GetParam() == "prm_star_mg" ? 1.03 : 1.01));
}

INSTANTIATE_TEST_SUITE_P(Planners, TransferWeights, ::testing::Values("prm_star_mg", "rrt_star_mg"),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace mmgrasp
