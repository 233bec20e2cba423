// Planning for arms whose joints turn more than once: every whole turn of a goal within limits is one.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mmgrasp/core/random.hpp"
#include "mmgrasp/plan/cartesian.hpp"
#include "mmgrasp/plan/manipulation.hpp"
#include "mmgrasp/plan/motion.hpp"
#include "mmgrasp/robot/detail/joint_metric.hpp"
#include "mmgrasp/robot/ik_branches.hpp"
#include "support/fetchlike.hpp"
#include "support/limited_arm.hpp"
#include "support/mesh_robots.hpp"

namespace mmgrasp {
namespace {

using Eigen::VectorXd;

VectorXd joints(double a, double b, double c, double d, double e, double f) {
  VectorXd q(6);
  q << a, b, c, d, e, f;
  return q;
}

/// A UR5e, whose joints but the elbow turn twice, in an empty world.
struct WoundArm {
  /// The least distance from q to an allowed configuration at the pose, of all turns of all branches.
  double least_distance(const VectorXd& q, const Pose& T) {
    double least = std::numeric_limits<double>::infinity();
    for (const VectorXd& end : all(T)) least = std::min(least, (end - q).norm());
    return least;
  }
  std::vector<VectorXd> all(const Pose& T) {
    return solve_ik_branches(
               group, T, {}, [this](const VectorXd& q) { return checker.rejection(q); }, 0, {}, true)
        .solutions;
  }
  MotionResult to_pose(const VectorXd& start, const VectorXd& goal, const std::string& planner = "rrt_connect") {
    MotionGoals goals;
    goals.tool_poses = {group.fk(goal)};
    MotionOptions options;
    options.planner = planner;
    return plan_motion_to(checker, start, goals, options);
  }

  JointGroup group = testing_support::ur5e_arm().group;
  CollisionChecker checker{group, {}};
};

TEST(WoundArms, DoesNotUnwindForAPoseNearby) {
  MMGRASP_NEEDS_SHARED_DATA();
  WoundArm arm;
  const VectorXd start = joints(0.3, -1.2, 1.4, -0.9, 0.8, 3.5);
  VectorXd goal = start;
  goal[5] = 3.6;
  const MotionResult one = arm.to_pose(start, goal);
  ASSERT_EQ(one.outcome, Outcome::solved);
  EXPECT_NEAR(one.cost, 0.1, 1e-4);
  // All joints but the elbow and one wrist wound up.
  const double turn = 2 * M_PI;
  const VectorXd wound = start + joints(-turn, turn, 0, turn, -turn, 0);
  ASSERT_TRUE(arm.checker.is_free(wound));
  goal = wound + joints(0.1, 0.05, -0.1, -0.08, 0.06, 0.1);
  const MotionResult two = arm.to_pose(wound, goal);
  ASSERT_EQ(two.outcome, Outcome::solved);
  EXPECT_NEAR(two.cost, (goal - wound).norm(), 1e-4);
  EXPECT_LT((two.path->waypoints.back() - goal).norm(), 1e-4);
}

TEST(WoundArms, UnwindsOnlyWhereLimitsMakeIt) {
  MMGRASP_NEEDS_SHARED_DATA();
  WoundArm arm;
  const VectorXd start = joints(0.3, -1.2, 1.4, -0.9, 0.8, 6.2);
  VectorXd goal = start;
  goal[5] = 6.5 - 2 * M_PI;  // Beyond the limit in the start's turn.
  const MotionResult result = arm.to_pose(start, goal);
  ASSERT_EQ(result.outcome, Outcome::solved);
  const double least = arm.least_distance(start, arm.group.fk(goal));
  EXPECT_GT(least, 1);
  EXPECT_NEAR(result.cost, least, 1e-4);
  EXPECT_TRUE(arm.group.within_limits(result.path->waypoints.back()));
}

TEST(WoundArms, RegionsAreReachedInTheNearestTurn) {
  MMGRASP_NEEDS_SHARED_DATA();
  WoundArm arm;
  const VectorXd start = joints(0.3, -1.2, 1.4, -0.9, 0.8, 3.5);
  VectorXd goal = start;
  goal[5] = 3.6;
  MotionGoals goals;
  ToolRegion region;
  region.T_world_region = arm.group.fk(goal);
  region.position = Eigen::Vector3d::Constant(0.01);
  goals.regions = {region};
  const MotionResult result = plan_motion_to(arm.checker, start, goals);
  ASSERT_EQ(result.outcome, Outcome::solved);
  EXPECT_LT(result.cost, 0.2);
}

/// Behind a wall, planners search: the path ends in one of the turns, and within limits.
TEST(WoundArms, PlannersReachTurnsBehindObstacles) {
  MMGRASP_NEEDS_SHARED_DATA();
  WoundArm arm;
  World world;
  world.add("wall", Shape(Box{{0.6, 0.02, 0.5}}), pose_from_xyz_rpy({0.75, 0, 0.5}, {0, 0, 0}));
  CollisionChecker checker(arm.group, world);
  const VectorXd start = joints(0.6, -0.9, 1.2, -0.6, 0.8, 3.5);
  VectorXd goal = start;
  goal[0] = -0.6;
  ASSERT_TRUE(checker.is_free(start) && checker.is_free(goal));
  MotionGoals goals;
  goals.tool_poses = {arm.group.fk(goal)};
  const MotionResult result = plan_motion_to(checker, start, goals);
  ASSERT_EQ(result.outcome, Outcome::solved);
  const VectorXd& end = result.path->waypoints.back();
  EXPECT_TRUE(arm.group.within_limits(end));
  EXPECT_LT((arm.group.fk(end).matrix() - arm.group.fk(goal).matrix()).norm(), 1e-3);
}

TEST(WoundArms, LinesStartInTheNearestTurn) {
  MMGRASP_NEEDS_SHARED_DATA();
  WoundArm arm;
  const VectorXd near = joints(0.3, -1.2, 1.4, -0.9, 0.8, 3.5);
  const VectorXd first = near + joints(0.02, 0.01, -0.02, 0.01, 0.02, 0.03);
  const Pose from = arm.group.fk(first);
  const CartesianResult result =
      plan_cartesian(arm.checker, {from, from * pose_from_xyz_rpy({0, 0, 0.05}, {0, 0, 0.2})}, near);
  ASSERT_EQ(result.outcome, Outcome::solved);
  EXPECT_LT((result.path->waypoints.front() - first).norm(), 1e-3);
}

/// The line turns the joint on, beyond its limit from the nearest turn; from the turn before it does not.
TEST(WoundArms, LinesStartATurnBackWhereLimitsEndThem) {
  const JointGroup group = test::limited_arm({{-6.2, 6.2}});
  CollisionChecker checker(group, {});
  const VectorXd near = VectorXd::Constant(1, 5.8), first = VectorXd::Constant(1, 5.85);
  const Pose from = group.fk(first);
  const auto line_over = [&](double turn) {
    return plan_cartesian(checker, {from, from * pose_from_xyz_rpy({0, 0, 0}, {0, 0, turn})}, near);
  };
  const CartesianResult on = line_over(0.2), back = line_over(0.8);
  ASSERT_EQ(on.outcome, Outcome::solved);
  EXPECT_NEAR(on.path->waypoints.front()[0], first[0], 1e-3);
  EXPECT_EQ(on.tried, 1);  // Another turn would draw the same line.
  ASSERT_EQ(back.outcome, Outcome::solved);
  EXPECT_NEAR(back.path->waypoints.front()[0], first[0] - 2 * M_PI, 1e-3);
  EXPECT_NEAR(back.path->waypoints.back()[0], first[0] - 2 * M_PI + 0.8, 1e-3);
  EXPECT_EQ(back.tried, 2);
  EXPECT_EQ(back.branches, 1);
}

/// Both ends are free to choose: the nearest turns of any two branches are the optimum in an empty world.
TEST(WoundArms, TransfersTakeTheNearestTurnsOfBothEnds) {
  MMGRASP_NEEDS_SHARED_DATA();
  WoundArm arm;
  LinkShape box;
  box.shape = Box{{0.01, 0.01, 0.01}};
  const VectorXd from = joints(0.3, -1.2, 1.4, -0.9, 0.8, 3.0), to = joints(0.5, -1.1, 1.5, -1.0, 0.9, 3.3);
  ManipulationProblem problem{arm.group, {}, {box}, arm.group.fk(from), arm.group.fk(to), {}};
  problem.grasps.push_back({Pose::Identity(), 0, 0});
  for (const Link& link : arm.group.robot().links()) problem.touch_links.insert(link.name);
  double least = std::numeric_limits<double>::infinity();
  for (const VectorXd& a : arm.all(problem.T_world_start))
    least = std::min(least, arm.least_distance(a, problem.T_world_goal));
  ASSERT_LT(least, (to - from).norm() + 1e-6);
  for (const char* planner : {"prm_star_mg", "rrt_star_mg"})
    for (const int first_grasps : {0, 4}) {
      ManipulationOptions options;
      options.planner = planner;
      options.ik_solutions = 8;
      options.first_grasps = first_grasps;
      options.prm.roadmap.vertices = 200;
      options.prm.roadmap.neighbours = 8;
      options.rrt.max_iterations = 100;
      const ManipulationResult result = plan_manipulation(problem, options);
      ASSERT_EQ(result.outcome, Outcome::solved) << planner;
      EXPECT_NEAR(result.cost, least, 1e-3) << planner;
      EXPECT_NEAR(result.lower_bound, least, 1e-3) << planner;
      for (const VectorXd& q : result.path->waypoints) EXPECT_TRUE(arm.group.within_limits(q));
    }
}

/// The pose differs by rounding alone, from which other arm configurations and another path could come.
TEST(ContinuousJoints, AFullTurnAtEitherEndChangesNothing) {
  const Robot robot = test::fetchlike(BaseKind::fixed);
  const JointGroup group = robot.group("arm");
  World world;
  world.add("post", Shape(Box{{0.1, 0.1, 2}}), Pose(Eigen::Translation3d(0.6, 0.1, 0.5)));
  CollisionChecker checker(group, world);
  LinkShape box;
  box.shape = Box{{0.01, 0.01, 0.01}};
  ManipulationProblem problem{group, world, {box}, {}, {}, {{Pose::Identity(), 0, 0}}};
  for (const Link& link : robot.links()) problem.touch_links.insert(link.name);
  Rng rng(3);
  for (int done = 0; done < 6;) {
    const VectorXd from = rng.uniform(group.sample_lower(), group.sample_upper());
    const VectorXd to = rng.uniform(group.sample_lower(), group.sample_upper());
    if (!checker.is_free(from) || !checker.is_free(to)) continue;
    ++done;
    for (const char* planner : {"prm_star_mg", "rrt_star_mg"}) {
      ManipulationOptions options;
      options.planner = planner;
      options.prm.roadmap.vertices = 300;
      options.rrt.max_iterations = 300;
      problem.T_world_start = group.fk(from);
      problem.T_world_goal = group.fk(to);
      const ManipulationResult result = plan_manipulation(problem, options);
      for (int i = 0; i < group.size(); ++i) {
        if (!group.wraps()[i]) continue;
        VectorXd turned_from = from, turned_to = to;
        turned_from[i] += 2 * M_PI;
        turned_to[i] -= 4 * M_PI;
        problem.T_world_start = group.fk(turned_from);
        problem.T_world_goal = group.fk(turned_to);
        const ManipulationResult turned = plan_manipulation(problem, options);
        EXPECT_EQ(turned.outcome, result.outcome) << planner << " " << done << " " << i;
        EXPECT_EQ(turned.cost, result.cost) << planner << " " << done << " " << i;
        EXPECT_NEAR(turned.lower_bound, result.lower_bound, 1e-9) << planner << " " << done << " " << i;
      }
    }
  }
}

/// Any path between two configurations is at least as long as the bound for their tool poses says, at the default
/// options: no list of arm postures may leave one of them out.
TEST(LowerBounds, HoldForEveryPathAtTheDefaults) {
  MMGRASP_NEEDS_SHARED_DATA();
  const std::vector<testing_support::MeshArm> arms{testing_support::ur5e_arm(), testing_support::panda_arm(),
                                                   testing_support::omni6_arm()};
  for (const auto& [name, group, reach, low, high] : arms) {
    CollisionChecker checker(group, {});
    const detail::JointMetric metric(group.wraps());
    LinkShape box;
    box.shape = Box{{0.01, 0.01, 0.01}};
    ManipulationProblem problem{group, {}, {box}, {}, {}, {{Pose::Identity(), 0, 0}}};
    for (const Link& link : group.robot().links()) problem.touch_links.insert(link.name);
    ManipulationOptions options;
    options.planner = "rrt_star_mg";
    options.rrt.max_iterations = 1;
    Rng rng(11);
    int done = 0, near = 0;
    while (done < 150) {
      const VectorXd from = rng.uniform(group.sample_lower(), group.sample_upper());
      VectorXd to = rng.uniform(group.sample_lower(), group.sample_upper());
      if (done % 2) to = from + 0.2 * (to - from);
      if (!checker.is_free(from) || !checker.is_free(to)) continue;
      ++done;
      problem.T_world_start = group.fk(from);
      problem.T_world_goal = group.fk(to);
      const ManipulationResult result = plan_manipulation(problem, options);
      EXPECT_LE(result.lower_bound, metric.distance(from, to) + 1e-4) << name << " " << done;
      near += result.lower_bound > 0.1 * metric.distance(from, to);
    }
    EXPECT_GT(near, 75) << name;  // The bound says something.
  }
}

}  // namespace
}  // namespace mmgrasp
