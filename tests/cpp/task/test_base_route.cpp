#include "mmgrasp/task/base_route.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "mmgrasp/collision/floor.hpp"
#include "mmgrasp/core/error.hpp"
#include "support/small_storeroom.hpp"

namespace mmgrasp {
namespace {

struct Room {
  PartSupplyProblem problem = test::small_storeroom();
  World world;

  BasePath plan(const Eigen::Vector3d& from, const Eigen::Vector3d& to, BaseKind base = BaseKind::diff_drive) {
    CollisionChecker checker(problem.arm, world);
    BaseRouteOptions options;
    options.base = base;
    return plan_base_route(checker, problem.home, from, to, options);
  }

  /// By the definition: ends, primitives, and a fresh checker every 5 mm or 0.02 rad.
  void expect_driveable(const BasePath& path, const Eigen::Vector3d& from, const Eigen::Vector3d& to, BaseKind base) {
    ASSERT_EQ(path.outcome, Outcome::solved);
    ASSERT_FALSE(path.poses.empty());
    EXPECT_LT((path.poses.front() - from).norm(), 1e-9);
    EXPECT_LT((path.poses.back() - to).head<2>().norm(), 1e-9);
    EXPECT_NEAR(wrap_angle(path.poses.back().z() - to.z()), 0, 1e-9);
    double length = 0, turning = 0;
    for (std::size_t i = 1; i < path.poses.size(); ++i) {
      const Eigen::Vector3d a = path.poses[i - 1], d = path.poses[i] - a;
      length += d.head<2>().norm();
      turning += std::abs(d.z());
      if (base == BaseKind::diff_drive && d.head<2>().norm() > 1e-9) {
        EXPECT_NEAR(d.z(), 0, 1e-9);
        EXPECT_NEAR(-std::sin(a.z()) * d.x() + std::cos(a.z()) * d.y(), 0, 1e-9);
      }
      const int steps = 1 + static_cast<int>(std::max(d.head<2>().norm() / 0.005, std::abs(d.z()) / 0.02));
      for (int k = 0; k <= steps; ++k) {
        const Pose root = pose_from_planar(a + d * (static_cast<double>(k) / steps));
        CollisionChecker checker(problem.arm.at(root), world);
        ASSERT_TRUE(checker.is_free(problem.home));
      }
    }
    EXPECT_NEAR(path.length, length, 1e-9);
    EXPECT_NEAR(path.turning, turning, 1e-9);
  }
};

TEST(BaseRoute, OpenFloorIsTurnDriveTurn) {
  Room room;
  const Eigen::Vector3d from(0, 0, 0), to(2, 1, M_PI / 2);
  const BasePath path = room.plan(from, to);
  room.expect_driveable(path, from, to, BaseKind::diff_drive);
  EXPECT_EQ(path.poses.size(), 4u);
  EXPECT_NEAR(path.length, std::sqrt(5.0), 1e-9);
  EXPECT_NEAR(path.turning, M_PI / 2, 1e-9);
}

TEST(BaseRoute, StraightBackwardsNeedsNoTurn) {
  Room room;
  const BasePath path = room.plan({1, 0, 0}, {-1, 0, 0});
  ASSERT_EQ(path.poses.size(), 2u);
  EXPECT_NEAR(path.turning, 0, 1e-9);
}

TEST(BaseRoute, StayingIsAPath) {
  Room room;
  const BasePath path = room.plan({1, 2, 0.5}, {1, 2, 0.5});
  EXPECT_EQ(path.outcome, Outcome::solved);
  EXPECT_EQ(path.length, 0);
}

TEST(BaseRoute, ThroughADoorInAWall) {
  for (BaseKind base : {BaseKind::diff_drive, BaseKind::omni}) {
    Room room;
    room.world.add("wall left", test::box_shape(0.1, 4.0, 1.0), test::at(1.5, 2.5, 0.5));
    room.world.add("wall right", test::box_shape(0.1, 3.0, 1.0), test::at(1.5, -1.9, 0.5));  // a gap from -0.4 to 0.5
    const Eigen::Vector3d from(0, 1.5, 0.3), to(3, 1.5, 1.2);
    const BasePath path = room.plan(from, to, base);
    room.expect_driveable(path, from, to, base);
    EXPECT_LT(path.length, 6.0);
    EXPECT_LE(path.poses.size(), 14u);
  }
}

TEST(BaseRoute, WhatStandsFarAwayMakesNoCellsCoarser) {
  for (const double away : {90.0, 1e4, 1e6}) {
    Room room;
    room.world.add("wall left", test::box_shape(0.1, 4.0, 1.0), test::at(1.5, 2.5, 0.5));
    room.world.add("wall right", test::box_shape(0.1, 3.0, 1.0), test::at(1.5, -1.9, 0.5));
    room.world.add("far away", test::box_shape(1.0, 1.0, 1.0), test::at(away, -away, 0.5));
    const Eigen::Vector3d from(0, 1.5, 0.3), to(3, 1.5, 1.2);
    const BasePath path = room.plan(from, to);
    room.expect_driveable(path, from, to, BaseKind::diff_drive);
    EXPECT_LT(path.length, 6.0) << away;
  }
}

TEST(BaseRoute, OutOfANicheTooTightToTurnIn) {
  Room room;
  for (double y : {-0.30, 0.30})
    room.world.add("side " + std::to_string(y), test::box_shape(0.8, 0.1, 1.0), test::at(0, y, 0.5));
  room.world.add("back", test::box_shape(0.1, 0.7, 1.0), test::at(-0.55, 0, 0.5));
  const Eigen::Vector3d from(0, 0, 0), to(0, 1.5, -2.0);
  const BasePath path = room.plan(from, to);
  room.expect_driveable(path, from, to, BaseKind::diff_drive);
}

/// Least distance from all boxes that a drive keeps farther than 1 m from both its ends, looked at every 2 mm or 0.004
/// rad.
double kept_in_passing(Room& room, const BasePath& path) {
  double least = std::numeric_limits<double>::infinity();
  CollisionChecker checker(room.problem.arm, room.world);
  for (std::size_t i = 1; i < path.poses.size(); ++i) {
    const Eigen::Vector3d a = path.poses[i - 1], d = path.poses[i] - a;
    const int steps = 1 + static_cast<int>(std::max(d.head<2>().norm() / 0.002, std::abs(d.z()) / 0.004));
    for (int k = 0; k <= steps; ++k) {
      const Eigen::Vector3d pose = a + d * (static_cast<double>(k) / steps);
      if ((pose - path.poses.front()).head<2>().norm() <= 1 || (pose - path.poses.back()).head<2>().norm() <= 1)
        continue;
      checker.set_root(pose_from_planar(pose));
      for (const DistanceResult& near : checker.distances(room.problem.home, 2.0)) {
        if (near.with_scene) least = std::min(least, near.value);
      }
    }
  }
  return least;
}

TEST(BaseRoute, KeepsItsClearanceInPassing) {
  for (BaseKind base : {BaseKind::diff_drive, BaseKind::omni}) {
    Room room;
    add_floor(room.world, room.problem.arm, 0.0);  // what the wheels stand on does not count
    room.world.add("pillar", test::box_shape(0.4, 0.4, 1.0), test::at(2.5, 0.1, 0.5));
    room.world.add("table", test::box_shape(0.4, 1.0, 0.8), test::at(-0.6, 0, 0.4));  // nearer than that at the start
    const Eigen::Vector3d from(0, 0, 0), to(5, 0, 0);
    CollisionChecker checker(room.problem.arm, room.world);
    BaseRouteOptions options;
    options.base = base;
    const BasePath close = plan_base_route(checker, room.problem.home, from, to, options);
    room.expect_driveable(close, from, to, base);
    EXPECT_LT(kept_in_passing(room, close), 0.1);
    for (const double clearance : {0.1, 0.3}) {
      options.clearance = clearance;
      const BasePath path = plan_base_route(checker, room.problem.home, from, to, options);
      room.expect_driveable(path, from, to, base);
      EXPECT_GE(kept_in_passing(room, path), clearance);
      EXPECT_GT(path.length, close.length);
    }
  }
}

TEST(BaseRoute, ADoorTooNarrowForTheClearanceIsNoWay) {
  Room room;
  room.world.add("wall left", test::box_shape(0.1, 8.0, 1.0), test::at(2.5, 4.5, 0.5));
  room.world.add("wall right", test::box_shape(0.1, 8.0, 1.0), test::at(2.5, -4.5, 0.5));  // a gap of 1 m
  CollisionChecker checker(room.problem.arm, room.world);
  BaseRouteOptions options;
  options.bounds = {Eigen::Vector2d(-1, -3), Eigen::Vector2d(6, 3)};
  EXPECT_EQ(plan_base_route(checker, room.problem.home, {0, 0, 0}, {5, 0, 0}, options).outcome, Outcome::solved);
  options.clearance = 0.5;
  EXPECT_EQ(plan_base_route(checker, room.problem.home, {0, 0, 0}, {5, 0, 0}, options).outcome, Outcome::not_found);
  options.clearance = -0.1;
  EXPECT_THROW(plan_base_route(checker, room.problem.home, {0, 0, 0}, {5, 0, 0}, options), InvalidInput);
}

/// A rod across the hand, 1.2 m long, and a door of 0.8 m that the robot passes with room to spare.
TEST(BaseRoute, WhatTheHandHoldsMustPassTheDoorToo) {
  Room room;
  room.world.add("wall left", test::box_shape(0.1, 8.0, 1.0), test::at(2.5, 4.4, 0.5));
  room.world.add("wall right", test::box_shape(0.1, 8.0, 1.0), test::at(2.5, -4.4, 0.5));
  room.world.add("rod", test::box_shape(0.02, 0.02, 0.02), test::at(0, 0, -5));
  BaseRouteOptions options;
  options.bounds = {Eigen::Vector2d(-1, -3), Eigen::Vector2d(6, 3)};
  const auto outcome = [&](const Eigen::Vector3d& size, double clearance) {
    World world = room.world;
    world.remove("rod");
    world.add("rod", test::box_shape(size.x(), size.y(), size.z()), Pose::Identity());
    const Pose T_root_hand = room.problem.arm.at(Pose::Identity()).fk(room.problem.home);
    Pose level = Pose::Identity();  // in the hand, but along the robot's own axes
    level.linear() = T_root_hand.linear().transpose();
    world.attach("rod", "tcp", level, {"left_finger", "right_finger", "hand"});
    CheckerOptions without_self;
    without_self.check_self = false;
    CollisionChecker checker(room.problem.arm, world, without_self);
    options.clearance = clearance;
    return plan_base_route(checker, room.problem.home, {0, 0, 0}, {5, 0, 0}, options).outcome;
  };
  EXPECT_EQ(outcome({0.02, 0.7, 0.02}, 0), Outcome::solved);
  EXPECT_EQ(outcome({0.02, 1.2, 0.02}, 0), Outcome::not_found) << "it can turn nowhere in the door";
  EXPECT_EQ(outcome({1.2, 0.02, 0.02}, 0), Outcome::solved) << "along the way it passes";
  EXPECT_EQ(outcome({0.02, 0.02, 0.02}, 0.1), Outcome::solved);
  EXPECT_EQ(outcome({0.02, 0.7, 0.02}, 0.1), Outcome::not_found) << "it keeps the clearance as the robot does";
}

TEST(BaseRoute, WalledInHasNoRoute) {
  Room room;
  for (double s : {-1.0, 1.0}) {
    room.world.add("x " + std::to_string(s), test::box_shape(0.1, 2.1, 1.0), test::at(s, 0, 0.5));
    room.world.add("y " + std::to_string(s), test::box_shape(2.1, 0.1, 1.0), test::at(0, s, 0.5));
  }
  EXPECT_EQ(room.plan({0, 0, 0}, {3, 0, 0}).outcome, Outcome::not_found);  // a search over a grid proves nothing
}

TEST(BaseRoute, AFixedBaseProvablyStays) {
  Room room;
  EXPECT_EQ(room.plan({0, 0, 0}, {3, 0, 0}, BaseKind::fixed).outcome, Outcome::infeasible);
  EXPECT_EQ(room.plan({0, 0, 0}, {0, 0, 0}, BaseKind::fixed).outcome, Outcome::solved);
}

TEST(BaseRoute, WalledInIsFoundFromTheOtherEndToo) {
  Room room;
  for (double s : {-1.0, 1.0}) {
    room.world.add("x " + std::to_string(s), test::box_shape(0.1, 2.1, 1.0), test::at(3 + s, 0, 0.5));
    room.world.add("y " + std::to_string(s), test::box_shape(2.1, 0.1, 1.0), test::at(3, s, 0.5));
  }
  CollisionChecker checker(room.problem.arm, room.world);
  BaseRouteOptions options;
  options.resolution = 0.05;
  options.bounds = {Eigen::Vector2d(-8, -8), Eigen::Vector2d(8, 8)};  // more base poses than a search looks at
  EXPECT_EQ(plan_base_route(checker, room.problem.home, {0, 0, 0}, {3, 0, 0}, options).outcome,
            Outcome::not_found);  // by a grid, no proof
}

TEST(BaseRoute, ASearchThatRanOutSaysSo) {
  Room room;  // a ring of walls with too small a gap for the robot, around both ends of a long way
  room.world.add("wall", test::box_shape(0.1, 60, 1.0), test::at(5, 0, 0.5));
  CollisionChecker checker(room.problem.arm, room.world);
  BaseRouteOptions options;
  options.resolution = 0.04;
  options.bounds = {Eigen::Vector2d(-12, -12), Eigen::Vector2d(22, 12)};
  EXPECT_EQ(plan_base_route(checker, room.problem.home, {0, 0, 0}, {10, 0, 0}, options).outcome, Outcome::timeout);
}

TEST(BaseRoute, TheBaseStaysInItsWorkspace) {
  Room room;
  BaseLimits limits = room.problem.robot.base_limits();
  EXPECT_GT(limits.workspace, 10);
  EXPECT_EQ(room.plan({0, 0, 0}, {limits.workspace + 1, 0, 0}).outcome, Outcome::invalid_goal);
  EXPECT_EQ(room.plan({0, -limits.workspace - 1, 0}, {0, 0, 0}).outcome, Outcome::invalid_start);
}

TEST(BaseRoute, EndsInCollisionAreNamed) {
  Room room;
  room.world.add("post", test::box_shape(0.1, 0.1, 1.0), test::at(2, 0, 0.5));
  EXPECT_EQ(room.plan({0, 0, 0}, {2, 0, 0}).outcome, Outcome::invalid_goal);
  EXPECT_EQ(room.plan({2, 0, 0}, {0, 0, 0}).outcome, Outcome::invalid_start);
}

TEST(BaseRoute, OmniBasesDriveAndTurnOnOneProfile) {
  BaseLimits limits;
  limits.linear_velocity = 0.5;
  limits.linear_acceleration = 0.25;
  limits.angular_velocity = 1.0;
  limits.angular_acceleration = 0.19;
  BasePath path;
  path.poses = {{0, 0, 0}, {2, 0, 1.9}};
  // The way's share: at most a quarter a second (2 m at 0.5 m/s), reached by a tenth a second squared (1.9 rad at
  // 0.19): 1 / 0.25 + 0.25 / 0.1 s. Way and turn by themselves take 6 and 6.3 s, but then not along the straight line.
  EXPECT_NEAR(base_path_duration(path, BaseKind::omni, limits), 6.5, 1e-9);
  const RobotMotion motion = base_path_motion(path, BaseKind::omni, limits, {}, Eigen::VectorXd(0));
  EXPECT_NEAR(motion.duration(), 6.5, 1e-9);
  for (const Eigen::Vector3d& pose : motion.base_poses) {
    EXPECT_NEAR(pose.y(), 0, 1e-12);
    EXPECT_NEAR(pose.z(), 0.95 * pose.x(), 1e-12);
  }
  EXPECT_EQ(motion.base_poses.back(), path.poses.back());
}

TEST(BaseRoute, MecanumWheelsTimeWhatTheyDoAtOnce) {
  BaseLimits limits;
  limits.linear_velocity = 0.8;
  limits.linear_acceleration = 0.5;
  limits.angular_velocity = 3;
  limits.angular_acceleration = 2;
  limits.wheel_velocity = 0.5;
  limits.wheel_separation = 0.4;
  limits.wheelbase = 0.5;
  const auto duration = [&](const std::vector<Eigen::Vector3d>& poses) {
    BasePath path;
    path.poses = poses;
    return base_path_duration(path, BaseKind::omni, limits);
  };
  // 2 m ahead or aside at 0.5 m/s; across, one pair of wheels does it all: 0.5 / sqrt(2) m/s.
  const double v = 0.5 / std::sqrt(2.0), d = std::sqrt(2.0);
  EXPECT_NEAR(duration({{0, 0, 0}, {2, 0, 0}}), 2 / 0.5 + 0.5 / 0.5, 1e-12);
  EXPECT_NEAR(duration({{0, 0, 0}, {0, -2, 0}}), 2 / 0.5 + 0.5 / 0.5, 1e-12);
  EXPECT_NEAR(duration({{0, 0, 0}, {d, d, 0}}), 2 / v + v / 0.5, 1e-12);
  EXPECT_NEAR(duration({{0, 0, M_PI / 4}, {d, d, M_PI / 4}}), 2 / 0.5 + 0.5 / 0.5, 1e-12);
  // On the spot: 0.5 m/s at (0.4 + 0.5) / 2 m.
  const double omega = 0.5 / 0.45;
  EXPECT_NEAR(duration({{1, 2, 0}, {1, 2, 3}}), 3 / omega + omega / 2, 1e-12);
  // While it turns by a right angle it comes by its worst heading: 2 m x sqrt(2) + 0.45 m x pi / 2 of the fastest rim.
  const double top = 0.5 / (2 * std::sqrt(2.0) + 0.45 * M_PI / 2);
  EXPECT_NEAR(duration({{0, 0, 0}, {2, 0, M_PI / 2}}), 1 / top + top / 0.25, 1e-12);  // 0.5 m/s^2 of 2 m
  BasePath path;
  path.poses = {{0, 0, 0.2}, {1.5, 2, 2.9}, {1, 2, -1}};
  double most = 0;
  const RobotMotion motion = base_path_motion(path, BaseKind::omni, limits, {}, Eigen::VectorXd(0), 1e-3);
  for (const Eigen::Vector3d& t : motion.base_twists)
    most = std::max(most, std::abs(t.x()) + std::abs(t.y()) + 0.45 * std::abs(t.z()));
  EXPECT_LE(most, 0.5 + 1e-12);
  EXPECT_GE(most, 0.5 - 1e-5);
}

TEST(BaseRoute, DurationOfTrapezoids) {
  BaseLimits limits;
  limits.linear_velocity = 0.5;
  limits.linear_acceleration = 0.25;
  limits.angular_velocity = 1.0;
  limits.angular_acceleration = 2.0;
  BasePath path;
  path.poses = {{0, 0, 0}, {2, 0, 0}, {2, 0, 0.25}, {2.5, 0, 0.25}};
  // 2 m: 2 / 0.5 + 0.5 / 0.25 = 6 s. 0.25 rad never reaches 1 rad/s: 2 sqrt(0.25 / 2). 0.5 m: 2 sqrt(0.5 / 0.25).
  const double expected = 6.0 + 2 * std::sqrt(0.125) + 2 * std::sqrt(2.0);
  EXPECT_NEAR(base_path_duration(path, BaseKind::diff_drive, limits), expected, 1e-9);
  // Wheels of 0.4 m/s, 2 m apart, drive at 0.4 m/s (2 m: 5 + 1.6 s, 0.5 m: below 0.64 m, a triangle still) and turn at
  // 0.4 rad/s (0.25 rad: 0.625 + 0.2 s). An omni base has no such wheels.
  limits.wheel_velocity = 0.4;
  limits.wheel_separation = 2;
  EXPECT_NEAR(base_path_duration(path, BaseKind::omni, limits), expected, 1e-9);
  EXPECT_NEAR(base_path_duration(path, BaseKind::diff_drive, limits), 6.6 + 0.825 + 2 * std::sqrt(2.0), 1e-9);
}

}  // namespace
}  // namespace mmgrasp
