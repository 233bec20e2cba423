#include <gtest/gtest.h>

#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/plan/motion.hpp"
#include "support/fcl_planar.hpp"
#include "support/planar_arm.hpp"
#include "support/vec.hpp"

namespace mmgrasp {
namespace {

using Eigen::VectorXd;
using test::SceneBox;
using test::vec;

constexpr double kLength = 0.4;

/// The tip of a planar arm at x, y with its axis at `angle`.
Pose planar_pose(double x, double y, double angle) {
  return pose_from_xyz_rpy({x, y, 0}, {0, 0, angle});
}

TEST(MotionGoals, AToolPoseIsReached) {
  const test::PlanarArm arm(4, kLength);
  const std::vector<SceneBox> wall{{{1.2, 0, 0}, {0.7, 0.1, 0.2}}};
  CollisionChecker checker(arm.group(), test::make_world(wall));
  MotionGoals goals;
  goals.tool_poses = {planar_pose(0.6, 0.8, 1.2)};
  const VectorXd start = vec({-1.0, 0.2, 0.2, 0.2});
  const MotionResult result = plan_motion_to(checker, start, goals);
  ASSERT_EQ(result.outcome, Outcome::solved);
  EXPECT_EQ(result.goal_index, 0);
  const VectorXd& end = result.path->waypoints.back();
  EXPECT_LT((arm.tip(end) - Eigen::Vector3d(0.6, 0.8, 0)).norm(), 1e-4);
  EXPECT_NEAR(std::remainder(end.sum() - 1.2, 2 * M_PI), 0, 1e-3);
  EXPECT_GT(test::fcl_path_clearance(arm, kLength, *result.path, wall, MotionOptions{}.joint_step / 8), 0);
}

TEST(MotionGoals, ARegionIsEnteredWhereItsMiddleIsBlocked) {
  const test::PlanarArm arm(4, kLength);
  // A post stands where the region's own pose has the tip.
  const std::vector<SceneBox> post{{{0.6, 0.8, 0}, {0.1, 0.1, 0.2}}};
  CollisionChecker checker(arm.group(), test::make_world(post));
  MotionGoals goals;
  goals.regions = {{planar_pose(0.6, 0.8, 1.2), {0.3, 0.3, 0}, {0, 0, 0.4}}};
  const MotionResult result = plan_motion_to(checker, vec({-1.0, 0.2, 0.2, 0.2}), goals);
  ASSERT_EQ(result.outcome, Outcome::solved);
  const VectorXd& end = result.path->waypoints.back();
  const Eigen::Rotation2Dd to_region(-1.2);
  const Eigen::Vector2d off = to_region * (arm.tip(end).head<2>() - Eigen::Vector2d(0.6, 0.8));
  EXPECT_LE(off.cwiseAbs().maxCoeff(), 0.3 + 1e-4);
  EXPECT_GT(off.cwiseAbs().maxCoeff(), 0.04);  // not in the post
  EXPECT_LE(std::abs(std::remainder(end.sum() - 1.2, 2 * M_PI)), 0.4 + 1e-3);
  EXPECT_GE(result.rejections.total(), 1u);  // its middle
}

TEST(MotionGoals, IndicesCountThroughTheLists) {
  const test::PlanarArm arm(4, kLength);
  CollisionChecker checker(arm.group(), World{});
  MotionGoals goals;
  goals.configurations = {vec({2.9, 0, 0, 0})};                           // beyond a limit
  goals.tool_poses = {planar_pose(5, 0, 0), planar_pose(0.6, 0.8, 1.2)};  // beyond reach, and good
  const MotionResult result = plan_motion_to(checker, vec({-1.0, 0.2, 0.2, 0.2}), goals);
  ASSERT_EQ(result.outcome, Outcome::solved);
  EXPECT_EQ(result.goal_index, 2);
  EXPECT_EQ(result.rejections.limits, 1u);
  EXPECT_EQ(result.rejections.unreachable, 1u);
}

TEST(MotionGoals, NothingInReachIsAnInvalidGoal) {
  const test::PlanarArm arm(3, kLength);
  CollisionChecker checker(arm.group(), World{});
  MotionGoals goals;
  goals.tool_poses = {planar_pose(5, 0, 0)};
  const MotionResult result = plan_motion_to(checker, vec({0, 0, 0}), goals);
  EXPECT_EQ(result.outcome, Outcome::invalid_goal);
  EXPECT_EQ(result.rejections.unreachable, 1u);
  EXPECT_THROW(plan_motion_to(checker, vec({0, 0, 0}), MotionGoals{}), InvalidInput);
  goals.tool_poses[0].linear()(0, 0) = 2;
  EXPECT_THROW(plan_motion_to(checker, vec({0, 0, 0}), goals), InvalidInput);
  goals.tool_poses.clear();
  goals.regions = {{Pose::Identity(), {0.1, -0.1, 0}, Eigen::Vector3d::Zero()}};
  EXPECT_THROW(plan_motion_to(checker, vec({0, 0, 0}), goals), InvalidInput);
}

/// The tool's axis is the sum of a planar arm's angles away from x.
TEST(OrientationConstraint, HoldsAlongThePath) {
  const test::PlanarArm arm(4, kLength, 0.02);
  const std::vector<SceneBox> wall{{{1.2, 0, 0}, {0.7, 0.1, 0.2}}};
  CollisionChecker checker(arm.group(), test::make_world(wall));
  const VectorXd start = vec({-0.9, 0.3, 0.3, 0.3}), goal = vec({0.9, -0.3, -0.3, -0.3});
  for (const char* planner : {"rrt_connect", "ompl_rrt_connect"}) {
    for (unsigned seed = 1; seed <= 3; ++seed) {
      MotionOptions options;
      options.planner = planner;
      options.seed = seed;
      options.time_limit = 100;
      options.max_iterations = 100000;
      options.orientation_constraint = OrientationConstraint{{2, 0, 0}, {1, 0, 0}, 0.3};
      const MotionResult result = plan_motion(checker, start, {goal}, options);
      ASSERT_EQ(result.outcome, Outcome::solved) << planner;
      EXPECT_GT(test::fcl_path_clearance(arm, kLength, *result.path, wall, options.joint_step / 8), 0);
      for (std::size_t i = 0; i + 1 < result.path->waypoints.size(); ++i) {
        for (int k = 0; k <= 50; ++k) {
          const VectorXd q =
              result.path->waypoints[i] + k / 50.0 * (result.path->waypoints[i + 1] - result.path->waypoints[i]);
          EXPECT_LE(std::abs(std::remainder(q.sum(), 2 * M_PI)), 0.3 + 1e-9);
        }
      }
      options.orientation_constraint.reset();
      const MotionResult without = plan_motion(checker, start, {goal}, options);
      ASSERT_TRUE(without.path);
      EXPECT_LE(without.cost, result.cost * 1.5);
    }
  }
}

TEST(OrientationConstraint, StartAndGoalsOutsideItAreRefused) {
  const test::PlanarArm arm(3, kLength);
  CollisionChecker checker(arm.group(), World{});
  MotionOptions options;
  options.orientation_constraint = OrientationConstraint{{1, 0, 0}, {1, 0, 0}, 0.2};
  const VectorXd inside = vec({0.3, -0.3, 0}), outside = vec({0.3, 0, 0});
  EXPECT_EQ(plan_motion(checker, outside, {inside}, options).outcome, Outcome::invalid_start);
  const MotionResult result = plan_motion(checker, inside, {outside}, options);
  EXPECT_EQ(result.outcome, Outcome::invalid_goal);
  EXPECT_EQ(result.rejections.grasp_filter, 1u);
  options.orientation_constraint->half_angle = 0;
  EXPECT_THROW(plan_motion(checker, inside, {inside}, options), InvalidInput);
  options.orientation_constraint = OrientationConstraint{{0, 0, 0}, {1, 0, 0}, 0.2};
  EXPECT_THROW(plan_motion(checker, inside, {inside}, options), InvalidInput);
}

/// A round platform with one arm joint whose link stays inside its outline.
struct Platform {
  static constexpr double kRadius = 0.25;
  explicit Platform(BaseKind kind) {
    RobotOptions options;
    options.base = kind;
    const std::string urdf =
        "<robot name='p'><link name='base'><collision><geometry><sphere radius='0.25'/></geometry></collision></link>"
        "<link name='a'/><joint name='j' type='revolute'><parent link='base'/><child link='a'/><axis xyz='0 0 1'/>"
        "<limit lower='-2' upper='2' velocity='1' effort='1'/></joint></robot>";
    robot = std::make_unique<Robot>(Robot::from_strings(urdf, "", options));
    group = std::make_unique<JointGroup>(robot->chain("base", "a", true));
  }
  std::unique_ptr<Robot> robot;
  std::unique_ptr<JointGroup> group;
};

/// Distance of the platform's middle from the outline of the boxes, by rulers.
double nearest_box(const std::vector<SceneBox>& scene, const Eigen::Vector2d& p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const SceneBox& box : scene) {
    const Eigen::Vector2d beyond = ((p - box.centre.head<2>()).cwiseAbs() - 0.5 * box.size.head<2>()).cwiseMax(0.0);
    nearest = std::min(nearest, beyond.norm());
  }
  return nearest;
}

/// Past a wall.
class BaseMotion : public ::testing::TestWithParam<std::string> {
 protected:
  MotionResult plan(const Platform& platform) const {
    CollisionChecker checker(*platform.group, test::make_world(wall_));
    MotionOptions options;
    options.planner = GetParam();
    options.max_iterations = 3000;
    options.time_limit = 100;
    return plan_motion(checker, start_, {goal_}, options);
  }

  const std::vector<SceneBox> wall_{{{1.5, 0.5, 0}, {0.2, 3.0, 0.5}}};
  const VectorXd start_ = vec({0, 0, 0.5, 0}), goal_ = vec({3, 0.4, -2.0, 1.0});
};

TEST_P(BaseMotion, ADiffDriveTurnsAndDrivesStraight) {
  const Platform platform(BaseKind::diff_drive);
  const MotionResult result = plan(platform);
  ASSERT_EQ(result.outcome, Outcome::solved);
  EXPECT_EQ(result.path->waypoints.front(), start_);
  const VectorXd end = result.path->waypoints.back();
  EXPECT_LT((end.head<2>() - goal_.head<2>()).norm(), 1e-12);
  EXPECT_NEAR(std::remainder(end[2] - goal_[2], 2 * M_PI), 0, 1e-12);
  EXPECT_NEAR(end[3], goal_[3], 1e-12);
  int drives = 0;
  for (std::size_t i = 0; i + 1 < result.path->waypoints.size(); ++i) {
    const VectorXd &a = result.path->waypoints[i], &b = result.path->waypoints[i + 1];
    const Eigen::Vector2d drive = (b - a).head<2>();
    if (drive.norm() > 1e-9) {
      ++drives;
      EXPECT_NEAR(b[2], a[2], 1e-9) << "turns while it drives";
      EXPECT_NEAR(drive[0] * std::sin(a[2]) - drive[1] * std::cos(a[2]), 0, 1e-6) << "slips sideways";
    }
    for (int k = 0; k <= 200; ++k) {
      EXPECT_GE(nearest_box(wall_, (a + k / 200.0 * (b - a)).head<2>()), Platform::kRadius - 2e-3);
    }
  }
  EXPECT_GE(drives, 2);
}

TEST_P(BaseMotion, AnOmniBaseMovesAsItLikes) {
  const Platform platform(BaseKind::omni);
  const MotionResult result = plan(platform);
  ASSERT_EQ(result.outcome, Outcome::solved);
  // Round the wall's lower end: the shortest path by geometry, without turns.
  EXPECT_GE(result.cost, 2 * std::hypot(1.5, 1.0));
  for (std::size_t i = 0; i + 1 < result.path->waypoints.size(); ++i) {
    const VectorXd &a = result.path->waypoints[i], &b = result.path->waypoints[i + 1];
    for (int k = 0; k <= 200; ++k) {
      EXPECT_GE(nearest_box(wall_, (a + k / 200.0 * (b - a)).head<2>()), Platform::kRadius - 2e-3);
    }
  }
}

TEST(BaseDriving, ADiffDriveGoesStraightHomeInFreeSpace) {
  const Platform platform(BaseKind::diff_drive);
  CollisionChecker checker(*platform.group, World{});
  // Backwards, without any turn.
  const MotionResult back = plan_motion(checker, vec({0, 0, 0, 0}), {vec({-2, 0, 0, 0})});
  ASSERT_TRUE(back.path);
  EXPECT_EQ(back.path->waypoints.size(), 2u);
  EXPECT_NEAR(back.cost, 2, 1e-12);
  // Sideways: a quarter turn, the drive, a quarter turn back.
  const MotionResult aside = plan_motion(checker, vec({0, 0, 0, 0}), {vec({0, 1, 0, 0})});
  ASSERT_TRUE(aside.path);
  EXPECT_NEAR(aside.cost, M_PI + 1, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(All, BaseMotion, ::testing::Values("rrt_connect", "ompl_rrt_connect"),
                         [](const auto& info) { return info.param; });

}  // namespace
}  // namespace mmgrasp
