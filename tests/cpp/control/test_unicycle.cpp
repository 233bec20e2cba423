#include "mmgrasp/control/unicycle.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "mmgrasp/core/error.hpp"

namespace mmgrasp {
namespace {

using Eigen::Vector3d;

TEST(Unicycle, ArcsAreThoseOfACircle) {
  // Left-hand circle of radius v / omega about the point at its left.
  const double v = 0.7, w = 0.4, t = 3.1, theta = 0.9;
  const Vector3d end = drive_arc({1, 2, theta}, {v, 0, w}, t);
  EXPECT_NEAR(end.x(), 1 + v / w * (std::sin(theta + w * t) - std::sin(theta)), 1e-14);
  EXPECT_NEAR(end.y(), 2 - v / w * (std::cos(theta + w * t) - std::cos(theta)), 1e-14);
  EXPECT_NEAR(end.z(), theta + w * t, 1e-15);
  // A full circle comes back and counts its turn; straight ahead needs no limit.
  EXPECT_LT((drive_arc({1, 2, theta}, {v, 0, w}, 2 * M_PI / w) - Vector3d(1, 2, theta + 2 * M_PI)).norm(), 1e-14);
  EXPECT_LT((drive_arc({0, 0, M_PI / 2}, {v, 0, 0}, 2) - Vector3d(0, 1.4, M_PI / 2)).norm(), 1e-15);
}

TEST(Unicycle, SidewaysAndSlowTurnsAgreeWithFineEulerSteps) {
  for (const Vector3d& velocity : {Vector3d(0.3, -0.2, 1.1), Vector3d(0.3, 0.2, 1e-5), Vector3d(-0.5, 0, 3e-4)}) {
    Vector3d pose(0.1, -0.4, 2.0);
    const Vector3d start = pose;
    const int steps = 200'000;
    const double h = 1.5 / steps;
    for (int k = 0; k < steps; ++k) {
      const double heading = pose.z() + velocity.z() * h / 2;
      pose.x() += h * (std::cos(heading) * velocity.x() - std::sin(heading) * velocity.y());
      pose.y() += h * (std::sin(heading) * velocity.x() + std::cos(heading) * velocity.y());
      pose.z() += h * velocity.z();
    }
    EXPECT_LT((drive_arc(start, velocity, 1.5) - pose).norm(), 1e-9);
  }
}

TEST(Unicycle, OneLongStepEqualsManyShortOnes) {
  const Vector3d velocity(0.6, 0.1, -0.8);
  Vector3d pose(0, 0, 0.3);
  for (int k = 0; k < 1000; ++k) pose = drive_arc(pose, velocity, 0.004);
  EXPECT_LT((pose - drive_arc({0, 0, 0.3}, velocity, 4)).norm(), 1e-12);
}

TEST(Unicycle, ArcVelocityIsTheInverse) {
  for (const Vector3d& velocity : {Vector3d(0.6, 0.1, -0.8), Vector3d(-0.4, 0, 0), Vector3d(0.2, 0, 1e-6)}) {
    const Vector3d from(3, -1, 2.5);
    EXPECT_LT((arc_velocity(from, drive_arc(from, velocity, 0.7), 0.7) - velocity).norm(), 1e-13);
  }
}

TEST(Unicycle, BadNumbersAreRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(drive_arc({nan, 0, 0}, Vector3d::Zero(), 1), InvalidInput);
  EXPECT_THROW(drive_arc(Vector3d::Zero(), {0, INFINITY, 0}, 1), InvalidInput);
  EXPECT_THROW(drive_arc(Vector3d::Zero(), Vector3d::Zero(), -1), InvalidInput);
  EXPECT_THROW(arc_velocity(Vector3d::Zero(), Vector3d::Zero(), 0), InvalidInput);
  EXPECT_THROW(arc_velocity(Vector3d::Zero(), {0, 0, 6.3}, 1), InvalidInput);
}

}  // namespace
}  // namespace mmgrasp
