#include "mmgrasp/plan/straight_line.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <fstream>
#include <thread>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "support/planar_arm.hpp"
#include "support/puma_arm.hpp"

namespace mmgrasp {
namespace {

using Eigen::VectorXd;

/// Distance of p from the segment a-b.
double off_segment(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d edge = b - a;
  const double t = edge.norm() > 0 ? std::clamp((p - a).dot(edge) / edge.squaredNorm(), 0.0, 1.0) : 0.0;
  return (p - a - t * edge).norm();
}

/// Every dense point's tool on the line, its rotation between the two ends', the motion continuous, the end reached.
void expect_line(const JointGroup& group, const JointPath& path, const Pose& from, const Pose& to,
                 double jump_threshold) {
  double last_progress = 0;
  for (std::size_t i = 0; i + 1 < path.waypoints.size(); ++i) {
    EXPECT_LE((path.waypoints[i + 1] - path.waypoints[i]).cwiseAbs().maxCoeff(), jump_threshold);
    for (int k = 0; k <= 10; ++k) {
      const Pose tool = group.fk(path.waypoints[i] + k / 10.0 * (path.waypoints[i + 1] - path.waypoints[i]));
      EXPECT_LE(off_segment(tool.translation(), from.translation(), to.translation()), 1e-4);
      // On the shortest rotation: the angles to both ends add up to the whole.
      EXPECT_NEAR(rotation_distance(from, tool) + rotation_distance(tool, to), rotation_distance(from, to), 2e-3);
      const double progress = (tool.translation() - from.translation()).norm();
      EXPECT_GE(progress, last_progress - 1e-4);
      last_progress = progress;
    }
  }
  const Pose end = group.fk(path.waypoints.back());
  EXPECT_LE((end.translation() - to.translation()).norm(), 1e-5);
  EXPECT_LE(rotation_distance(end, to), 1e-4);
}

Pose moved(const Pose& T, const Eigen::Vector3d& offset, const Eigen::Vector3d& rotation = Eigen::Vector3d::Zero()) {
  Pose result = T;
  result.translation() += offset;
  if (rotation.norm() > 0) {
    result.linear() = Eigen::AngleAxisd(rotation.norm(), rotation.normalized()).toRotationMatrix() * T.linear();
  }
  return result;
}

TEST(StraightLine, SixAxisArmFollowsLinesAndRotations) {
  const test::PumaArm arm;
  CollisionChecker checker(arm.group(), World{});
  Rng rng(6);
  int solved = 0;
  for (int repeat = 0; repeat < 30; ++repeat) {
    VectorXd q(6);
    q << rng.uniform(-2, 2), rng.uniform(-1.4, -0.6), rng.uniform(1.2, 2.0), rng.uniform(-0.5, 0.5),
        rng.uniform(0.6, 1.2), rng.uniform(-1, 1);
    const Pose from = arm.group().fk(q);
    const Eigen::Vector3d offset(rng.uniform(-0.15, 0.15), rng.uniform(-0.15, 0.15), rng.uniform(-0.15, 0.15));
    const Eigen::Vector3d rotation =
        repeat % 2 ? Eigen::Vector3d(rng.uniform(-0.3, 0.3), rng.uniform(-0.3, 0.3), 0.2) : Eigen::Vector3d::Zero();
    const Pose to = moved(from, offset, rotation);
    const StraightLineOptions options;
    const StraightLineResult result = plan_straight_line(checker, q, to, options);
    if (result.outcome != Outcome::solved) {
      EXPECT_FALSE(result.path);
      EXPECT_NE(result.cause, Rejection::none);
      EXPECT_LT(result.fraction, 1.0);
      continue;
    }
    ++solved;
    EXPECT_EQ(result.fraction, 1.0);
    EXPECT_EQ(result.cause, Rejection::none);
    EXPECT_EQ(result.path->waypoints.front(), q);
    expect_line(arm.group(), *result.path, from, to, options.jump_threshold);
  }
  EXPECT_GE(solved, 25);
}

TEST(StraightLine, OutOfReachNamesReachAndHowFarItGot) {
  const test::PumaArm arm;
  CollisionChecker checker(arm.group(), World{});
  VectorXd q(6);
  q << 0.1, -1.0, 1.5, 0.0, 0.8, 0.0;
  const Pose from = arm.group().fk(q);
  const StraightLineResult result = plan_straight_line(checker, q, moved(from, {3.0, 0, 0}));
  EXPECT_EQ(result.outcome, Outcome::not_found);
  EXPECT_EQ(result.cause, Rejection::unreachable);
  EXPECT_FALSE(result.path);
  // The arm's own length bounds how far it can have gone.
  EXPECT_GT(result.fraction, 0.0);
  EXPECT_LT(from.translation().x() + 3.0 * result.fraction, arm.reach());
}

TEST(StraightLine, StopsAtASceneObstacle) {
  const test::PumaArm arm;
  VectorXd q(6);
  q << 0.1, -1.0, 1.5, 0.0, 0.8, 0.0;
  const Pose from = arm.group().fk(q);
  // A ball straight ahead of the hand: it is touched after the gap.
  const Eigen::Vector3d ahead = from.linear().col(2);
  const double gap = 0.1, radius = 0.03;
  World world;
  world.add("ball", Sphere{radius}, moved(Pose::Identity(), from.translation() + (gap + radius) * ahead));
  CollisionChecker checker(arm.group(), world);
  ASSERT_TRUE(checker.is_free(q));
  const StraightLineResult result = plan_straight_line(checker, q, moved(from, 0.2 * ahead));
  EXPECT_EQ(result.outcome, Outcome::not_found);
  EXPECT_EQ(result.cause, Rejection::scene);
  ASSERT_TRUE(result.contact);
  EXPECT_EQ(result.contact->b, "ball");
  EXPECT_LE(0.2 * result.fraction, gap + 1e-4);
  EXPECT_GE(0.2 * result.fraction, gap - 0.006);
}

TEST(StraightLine, StopsAtAJointLimit) {
  // The elbow is nearly at its limit: pulling the tool towards the shoulder bends it further.
  const test::PumaArm arm(1.6);
  CollisionChecker checker(arm.group(), World{});
  VectorXd q(6);
  q << 0.0, -1.0, 1.5, 0.0, 0.8, 0.0;
  const Pose from = arm.group().fk(q);
  const StraightLineResult result =
      plan_straight_line(checker, q, moved(from, 0.2 * (Eigen::Vector3d(0, 0, 0.3) - from.translation()).normalized()));
  EXPECT_EQ(result.outcome, Outcome::not_found);
  EXPECT_EQ(result.cause, Rejection::limits);
}

TEST(StraightLine, AStartInCollisionIsRefused) {
  const test::PumaArm arm;
  VectorXd q(6);
  q << 0.1, -1.0, 1.5, 0.0, 0.8, 0.0;
  const Pose from = arm.group().fk(q);
  World world;
  world.add("ball", Sphere{0.05}, moved(Pose::Identity(), from.translation()));
  CollisionChecker checker(arm.group(), world);
  const StraightLineResult result = plan_straight_line(checker, q, moved(from, {0.1, 0, 0}));
  EXPECT_EQ(result.outcome, Outcome::invalid_start);
  EXPECT_EQ(result.cause, Rejection::scene);
  ASSERT_TRUE(result.contact);
  EXPECT_EQ(result.contact->b, "ball");
}

TEST(StraightLine, AStartBeyondLimitsIsReportedByJointValueAndLimits) {
  const test::PumaArm arm(1.6);
  CollisionChecker checker(arm.group(), World{});
  VectorXd q(6);
  q << 0.1, -1.0, 1.75, 0.0, 0.8, 0.0;
  const StraightLineResult result = plan_straight_line(checker, q, arm.group().fk(q));
  EXPECT_EQ(result.outcome, Outcome::invalid_start);
  EXPECT_EQ(result.cause, Rejection::limits);
  for (const char* word : {"j3", "1.75", "[-1.6, 1.6]"})
    EXPECT_NE(result.beyond_limits.find(word), std::string::npos) << result.beyond_limits;
  q[2] = 1.5;
  EXPECT_EQ(plan_straight_line(checker, q, arm.group().fk(q)).beyond_limits, "");
}

TEST(StraightLine, DoesNothingMoreOnceStopped) {
  const test::PumaArm arm;
  CollisionChecker checker(arm.group(), World{});
  VectorXd q(6);
  q << 0.1, -1.0, 1.5, 0.0, 0.8, 0.0;
  const Pose to = moved(arm.group().fk(q), {0, 0.1, 0});
  std::vector<double> reported;
  std::size_t queries = 0;
  Monitor monitor;
  monitor.progress = [&](const std::string&, double fraction) {
    reported.push_back(fraction);
    if (reported.size() != 3) return;
    queries = checker.queries();
    monitor.stop.stop();
  };
  const StraightLineResult result = plan_straight_line(checker, q, to, {}, monitor);
  EXPECT_EQ(result.outcome, Outcome::stopped);
  EXPECT_FALSE(result.path);
  EXPECT_EQ(reported.size(), 3u);
  EXPECT_EQ(result.fraction, reported.back());
  EXPECT_NEAR(result.fraction, 3 * StraightLineOptions{}.position_step / 0.1, 1e-9);
  EXPECT_EQ(checker.queries(), queries);
}

TEST(StraightLine, StepsTooFineToWaitForCanBeStopped) {
  const test::PumaArm arm;
  VectorXd q(6);
  q << 0.1, -1.0, 1.5, 0.0, 0.8, 0.0;
  const Pose to = moved(arm.group().fk(q), {0, 0.1, 0});
  StraightLineOptions many_waypoints, many_checks;
  many_waypoints.position_step = 1e-12;
  many_checks.joint_step = 1e-12;
  for (const StraightLineOptions& options : {many_waypoints, many_checks}) {
    CollisionChecker checker(arm.group(), World{});
    Monitor monitor;
    std::thread stopper([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      monitor.stop.stop();
    });
    const StraightLineResult result = plan_straight_line(checker, q, to, options, monitor);
    stopper.join();
    EXPECT_EQ(result.outcome, Outcome::stopped);
  }
}

TEST(StraightLine, NoMotionIsATrivialLine) {
  const test::PumaArm arm;
  CollisionChecker checker(arm.group(), World{});
  VectorXd q(6);
  q << 0.1, -1.0, 1.5, 0.0, 0.8, 0.0;
  const StraightLineResult result = plan_straight_line(checker, q, arm.group().fk(q));
  ASSERT_EQ(result.outcome, Outcome::solved);
  EXPECT_LT(result.path->length(), 1e-6);
}

TEST(StraightLine, RefusesBadInput) {
  const test::PumaArm arm;
  CollisionChecker checker(arm.group(), World{});
  const VectorXd q = VectorXd::Zero(6);
  Pose bad = Pose::Identity();
  bad.translation().x() = std::nan("");
  EXPECT_THROW(plan_straight_line(checker, q, bad), InvalidInput);
  EXPECT_THROW(plan_straight_line(checker, VectorXd::Zero(5), Pose::Identity()), InvalidInput);
  StraightLineOptions options;
  options.position_step = 0;
  EXPECT_THROW(plan_straight_line(checker, q, Pose::Identity(), options), InvalidInput);
}

}  // namespace
}  // namespace mmgrasp
