#include "mmgrasp/robot/base_motion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/robot/robot.hpp"
#include "support/small_robots.hpp"

namespace mmgrasp {
namespace {

using Eigen::Vector3d;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

// P3 3.12 written out: v_x = x' cos + y' sin, v_y = -x' sin + y' cos, omega = theta'.
TEST(BaseMotion, PlatformVelocityIsTheJointVelocityInThePlatformsFrame) {
  for (const double theta : {0.0, 0.3, M_PI / 2, 2.5, -3.0, 9.0}) {
    const Vector3d joints(0.7, -0.2, 0.4);
    const double c = std::cos(theta), s = std::sin(theta);
    const Vector3d v = platform_velocity(theta, joints);
    EXPECT_NEAR(v[0], 0.7 * c - 0.2 * s, 1e-15);
    EXPECT_NEAR(v[1], -0.7 * s - 0.2 * c, 1e-15);
    EXPECT_EQ(v[2], 0.4);
    EXPECT_LT((joint_velocity(theta, v) - joints).norm(), 1e-15);
  }
  // A platform that looks along +y and drives ahead moves the joint y.
  EXPECT_LT((joint_velocity(M_PI / 2, {0.5, 0, 0}) - Vector3d(0, 0.5, 0)).norm(), 1e-15);
}

TEST(BaseMotion, PlatformVelocityIsTheDerivativeOfTheMotion) {
  // Driving at constant command for a short time along the exact arc: the platform's displacement in its own frame is
  // the command times the time, up to the second order.
  const double theta = 0.8, h = 1e-6;
  const Vector3d command(0.4, 0.1, 0.9);
  const Vector3d step = h * joint_velocity(theta + 0.5 * h * command[2], command);  // midpoint rule
  const Vector3d seen = platform_velocity(theta, step / h);
  EXPECT_LT((seen - command).norm(), 1e-6);
}

TEST(BaseMotion, WheelSpeedsUseTheWheelSeparation) {
  // v = (l + r) / 2, omega = (r - l) / W. With half of W (a "radius", as printed in P1 4.11) omega would be 1.2.
  const WheelSpeeds wheels = wheel_speeds(0.5, 0.6, 0.4);
  EXPECT_NEAR(wheels.right - wheels.left, 0.6 * 0.4, 1e-15);
  EXPECT_NEAR(wheels.right + wheels.left, 2 * 0.5, 1e-15);
  const Vector3d back = platform_velocity(wheels, 0.4);
  EXPECT_NEAR(back[0], 0.5, 1e-15);
  EXPECT_EQ(back[1], 0);
  EXPECT_NEAR(back[2], 0.6, 1e-15);
  // Turning left on the spot: the right wheel forwards, a full turn takes pi W of it.
  const WheelSpeeds turn = wheel_speeds(0, 2 * M_PI, 0.4);
  EXPECT_NEAR(turn.right, M_PI * 0.4, 1e-15);
  EXPECT_NEAR(turn.left, -M_PI * 0.4, 1e-15);
  // Left wheel standing: a turn about it, its middle half the separation away.
  const WheelSpeeds about = wheel_speeds(0.2 * 1.5, 1.5, 0.4);
  EXPECT_NEAR(about.left, 0, 1e-15);
}

TEST(BaseMotion, ScaleKeepsEveryLimitAndNoMore) {
  BaseLimits limits;
  limits.linear_velocity = 0.6;
  limits.angular_velocity = 1.0;
  EXPECT_EQ(velocity_scale(BaseKind::omni, limits, {0.3, 0.4, 0.9}), 1);
  EXPECT_NEAR(velocity_scale(BaseKind::omni, limits, {0.6, 0.8, 0.9}), 0.6, 1e-15);  // 1 m/s
  EXPECT_NEAR(velocity_scale(BaseKind::omni, limits, {0.6, 0.0, -2.5}), 0.4, 1e-15);
  EXPECT_EQ(velocity_scale(BaseKind::diff_drive, limits, {0.6, 0, 1}), 1);  // wheels set no limit
  limits.wheel_velocity = 0.5;
  limits.wheel_separation = 0.4;
  EXPECT_NEAR(velocity_scale(BaseKind::diff_drive, limits, {0.6, 0, 1}), 0.5 / 0.8, 1e-15);
  EXPECT_NEAR(velocity_scale(BaseKind::diff_drive, limits, {-0.6, 0, 1}), 0.5 / 0.8, 1e-15);  // the left wheel
  EXPECT_EQ(velocity_scale(BaseKind::diff_drive, limits, {0.3, 0, 1}), 1);
  EXPECT_EQ(velocity_scale(BaseKind::omni, limits, {0.6, 0, 1}), 1);
}

TEST(BaseMotion, WhatABaseCannotDoIsScaledToNothing) {
  const BaseLimits limits;
  EXPECT_EQ(velocity_scale(BaseKind::diff_drive, limits, {0.1, 1e-3, 0}), 0);
  EXPECT_EQ(velocity_scale(BaseKind::diff_drive, limits, {0, 1e-12, 0}), 0);
  EXPECT_EQ(velocity_scale(BaseKind::diff_drive, limits, {0.1, 1e-11, 0}), 1);  // rounding
  EXPECT_EQ(velocity_scale(BaseKind::fixed, limits, {0, 0, 1e-12}), 0);
  EXPECT_EQ(velocity_scale(BaseKind::fixed, limits, {0, 0, 0}), 1);
}

TEST(BaseMotion, DrivingLimitsFoldTheWheelsIn) {
  BaseLimits limits;
  limits.linear_velocity = 0.6;
  limits.angular_velocity = 3;
  limits.wheel_velocity = 0.5;
  limits.wheel_separation = 0.4;
  const BaseLimits driving = driving_limits(BaseKind::diff_drive, limits);
  EXPECT_NEAR(driving.linear_velocity, 0.5, 1e-15);
  EXPECT_NEAR(driving.angular_velocity, 2.5, 1e-15);  // 0.5 m/s at 0.2 m
  EXPECT_EQ(driving.linear_acceleration, limits.linear_acceleration);
  EXPECT_EQ(driving_limits(BaseKind::omni, limits).angular_velocity, 3);
}

BaseLimits mecanum() {
  BaseLimits limits;
  limits.linear_velocity = limits.angular_velocity = 10;
  limits.wheel_velocity = 0.5;
  limits.wheel_separation = 0.4;
  limits.wheelbase = 0.5;
  return limits;
}

/// Rims by kinematics of each wheel: the velocity of its middle, and what of it the free rollers at 45 degrees leave.
double fastest_rim(const Vector3d& v) {
  double most = 0;
  for (const int front : {1, -1}) {
    for (const int left : {1, -1}) {
      const Eigen::Vector2d at(0.25 * front, 0.2 * left), moves(v[0] - v[2] * at[1], v[1] + v[2] * at[0]);
      most = std::max(most, std::abs(moves[0] - front * left * moves[1]));
    }
  }
  return most;
}

TEST(BaseMotion, MecanumWheelsShareWhatTheyCanDo) {
  const BaseLimits limits = mecanum();
  const WheelRows rows = wheel_rows(BaseKind::omni, limits);
  ASSERT_EQ(rows.rows(), 4);
  for (int i = 0; i < 200; ++i) {
    const Vector3d v(std::sin(1.7 * i), std::cos(2.3 * i), 2 * std::sin(0.9 * i + 1));
    EXPECT_NEAR((rows * v).cwiseAbs().maxCoeff(), fastest_rim(v), 1e-12);
    EXPECT_NEAR(velocity_scale(BaseKind::omni, limits, v), std::min(1.0, 0.5 / fastest_rim(v)), 1e-12);
  }
  EXPECT_NEAR(velocity_scale(BaseKind::omni, limits, {0, 0, 2}), 0.5 / 0.9, 1e-12);  // on the spot: 0.45 m
  EXPECT_NEAR(velocity_scale(BaseKind::omni, limits, {1, 1, 0}), 0.25, 1e-12);       // one pair stands still
  EXPECT_NEAR(driving_limits(BaseKind::omni, limits).angular_velocity, 0.5 / 0.45, 1e-12);
  EXPECT_EQ(wheel_rows(BaseKind::omni, {}).rows(), 0);
  EXPECT_EQ(wheel_rows(BaseKind::diff_drive, {}).rows(), 0);
  EXPECT_EQ(wheel_rows(BaseKind::fixed, limits).rows(), 0);
  const WheelRows two = wheel_rows(BaseKind::diff_drive, limits);
  const WheelSpeeds wheels = wheel_speeds(0.3, 0.7, 0.4);
  ASSERT_EQ(two.rows(), 2);
  EXPECT_NEAR(two.row(0) * Vector3d(0.3, 0, 0.7), wheels.left, 1e-15);
  EXPECT_NEAR(two.row(1) * Vector3d(0.3, 0, 0.7), wheels.right, 1e-15);
}

TEST(BaseMotion, TheFastestRimOfATurningDriveIsThatOfManyHeadings) {
  const WheelRows rows = wheel_rows(BaseKind::omni, mecanum());
  for (int i = 0; i < 100; ++i) {
    const Vector3d way(2 * std::sin(1.7 * i), std::cos(2.3 * i), 4 * std::sin(0.9 * i + 1));
    const double from = 3 * std::cos(0.7 * i), most = largest_rim_travel(rows, from, way);
    double seen = 0;
    for (int k = 0; k <= 4000; ++k)
      seen = std::max(seen, fastest_rim(platform_velocity(from + way.z() * k / 4000, way)));
    EXPECT_GE(most, seen - 1e-12) << i;
    EXPECT_LE(most, seen * (1 + 1e-6)) << i;
  }
  EXPECT_EQ(largest_rim_travel(WheelRows(0, 3), 0.1, {1, 2, 3}), 0);
}

TEST(BaseMotion, BadNumbersAreRefused) {
  EXPECT_THROW(platform_velocity(kNan, Vector3d::Zero()), InvalidInput);
  EXPECT_THROW(platform_velocity(0, Vector3d(0, kNan, 0)), InvalidInput);
  EXPECT_THROW(joint_velocity(0, Vector3d(0, 0, INFINITY)), InvalidInput);
  EXPECT_THROW(wheel_speeds(0.1, 0.1, 0), InvalidInput);
  EXPECT_THROW(wheel_speeds(0.1, 0.1, -1), InvalidInput);
  EXPECT_THROW(platform_velocity(WheelSpeeds{0.1, kNan}, 0.5), InvalidInput);
  EXPECT_THROW(velocity_scale(BaseKind::omni, {}, {kNan, 0, 0}), InvalidInput);
  BaseLimits limits;
  limits.wheel_velocity = 0;
  EXPECT_THROW(limits.check(), InvalidInput);
  limits.wheel_velocity = kNan;
  EXPECT_THROW(limits.check(), InvalidInput);
  limits.wheel_velocity = 0.5;
  limits.wheel_separation = std::numeric_limits<double>::infinity();
  EXPECT_THROW(limits.check(), InvalidInput);
  limits = {};
  for (const double wheelbase : {-0.1, kNan, std::numeric_limits<double>::infinity()}) {
    limits.wheelbase = wheelbase;
    EXPECT_THROW(limits.check(), InvalidInput);
  }
}

TEST(BaseMotion, TheRobotsHashSeesTheWheels) {
  const auto hash = [](double velocity, double separation) {
    RobotOptions options;
    options.base = BaseKind::diff_drive;
    options.base_limits.wheel_velocity = velocity;
    options.base_limits.wheel_separation = separation;
    return Robot::from_strings(test::two_balls_urdf(), "", options).hash();
  };
  EXPECT_EQ(hash(0.5, 0.4), hash(0.5, 0.4));
  EXPECT_NE(hash(0.5, 0.4), hash(0.6, 0.4));
  EXPECT_NE(hash(0.5, 0.4), hash(0.5, 0.5));
}

}  // namespace
}  // namespace mmgrasp
