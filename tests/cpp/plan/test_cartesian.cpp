#include "mmgrasp/plan/cartesian.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <thread>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "support/planar_arm.hpp"
#include "support/puma_arm.hpp"

namespace mmgrasp {
namespace {

using Eigen::VectorXd;

double off_segment(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d edge = b - a;
  const double t = std::clamp((p - a).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
  return (p - a - t * edge).norm();
}

void expect_lines(const JointGroup& group, const CartesianResult& result, const Poses& poses, double jump_threshold) {
  ASSERT_TRUE(result.path);
  ASSERT_EQ(result.corners.size(), poses.size());
  EXPECT_EQ(result.corners.front(), 0);
  EXPECT_EQ(result.corners.back() + 1, static_cast<int>(result.path->waypoints.size()));
  EXPECT_EQ(result.fraction, 1);
  for (std::size_t line = 0; line + 1 < poses.size(); ++line) {
    for (int i = result.corners[line]; i < result.corners[line + 1]; ++i) {
      const VectorXd &a = result.path->waypoints[i], &b = result.path->waypoints[i + 1];
      EXPECT_LE((b - a).cwiseAbs().maxCoeff(), jump_threshold);
      for (int k = 0; k <= 5; ++k) {
        const Pose tool = group.fk(a + k / 5.0 * (b - a));
        EXPECT_LE(off_segment(tool.translation(), poses[line].translation(), poses[line + 1].translation()), 1e-4);
      }
    }
    const Pose corner = group.fk(result.path->waypoints[result.corners[line + 1]]);
    EXPECT_LT((corner.translation() - poses[line + 1].translation()).norm(), 1e-5);
    EXPECT_LT(rotation_distance(corner, poses[line + 1]), 1e-4);
  }
}

TEST(Cartesian, EveryBranchIsTriedWhereOneJumps) {
  const test::PumaArm arm;
  CollisionChecker checker(arm.group(), World{});
  Rng rng(8);
  int by_line = 0, by_branches = 0, rescued = 0;
  for (int repeat = 0; repeat < 40; ++repeat) {
    const VectorXd near = rng.uniform(arm.group().sample_lower(), arm.group().sample_upper());
    if (!checker.is_free(near)) continue;
    Poses poses{arm.group().fk(near)};
    for (int i = 0; i < 2; ++i) {
      Pose next = poses.back();
      next.translation() += 0.15 * Eigen::Vector3d(rng.normal(), rng.normal(), rng.normal());
      poses.push_back(next);
    }
    VectorXd q = near;
    bool line = true;
    for (std::size_t i = 1; i < poses.size() && line; ++i) {
      const StraightLineResult one = plan_straight_line(checker, q, poses[i]);
      line = one.outcome == Outcome::solved;
      if (line) q = one.path->waypoints.back();
    }
    const CartesianResult result = plan_cartesian(checker, poses, near);
    by_line += line;
    by_branches += result.outcome == Outcome::solved;
    rescued += !line && result.path;
    EXPECT_FALSE(line && !result.path) << "the first branch would have done";
    if (result.path) {
      expect_lines(arm.group(), result, poses, CartesianOptions{}.line.jump_threshold);
    } else {
      EXPECT_LT(result.fraction, 1);
      EXPECT_NE(result.cause, Rejection::none);
      EXPECT_EQ(result.tried, result.branches);
    }
  }
  EXPECT_GT(by_line, 5);
  EXPECT_GT(rescued, 0);
  EXPECT_EQ(by_branches, by_line + rescued);
}

TEST(Cartesian, BeginsAtTheNearestBranchThatCompletes) {
  const test::PumaArm arm;
  CollisionChecker checker(arm.group(), World{});
  VectorXd near(6);
  near << 0.3, -0.8, 1.2, 0.4, 0.7, 0.2;
  ASSERT_TRUE(checker.is_free(near));
  Poses poses{arm.group().fk(near), arm.group().fk(near)};
  poses[1].translation() += Eigen::Vector3d(0, 0.05, 0.05);
  const CartesianResult result = plan_cartesian(checker, poses, near);
  ASSERT_EQ(result.outcome, Outcome::solved);
  EXPECT_EQ(result.path->waypoints.front(), near);
  EXPECT_GT(result.branches, 1);
  // The others are farther away than this one's whole path is long: none had to be tried.
  EXPECT_LT(result.tried, result.branches);
  const CartesianResult again = plan_cartesian(checker, poses);
  ASSERT_TRUE(again.path);
  EXPECT_EQ(again.tried, again.branches);
  expect_lines(arm.group(), again, poses, 0.2);
}

TEST(Cartesian, SaysHowFarItCame) {
  const test::PumaArm arm;
  CollisionChecker checker(arm.group(), World{});
  VectorXd q(6);
  q << 0.3, -0.8, 1.2, 0.4, 0.7, 0.2;
  Poses poses{arm.group().fk(q), arm.group().fk(q), arm.group().fk(q)};
  poses[1].translation() += Eigen::Vector3d(0, 0.05, 0.05);
  poses[2].translation() += Eigen::Vector3d(0, 5, 0);
  const CartesianResult result = plan_cartesian(checker, poses, q);
  EXPECT_EQ(result.outcome, Outcome::not_found);
  EXPECT_FALSE(result.path);
  EXPECT_GE(result.fraction, 0.5);
  EXPECT_LT(result.fraction, 1);
  poses[0].translation() += Eigen::Vector3d(9, 0, 0);
  const CartesianResult nowhere = plan_cartesian(checker, poses);
  EXPECT_EQ(nowhere.outcome, Outcome::not_found);
  EXPECT_EQ(nowhere.branches, 0);
  EXPECT_EQ(nowhere.cause, Rejection::unreachable);
}

TEST(Cartesian, AStartInCollisionNamesThePair) {
  const test::PumaArm arm;
  VectorXd q(6);
  q << 0.3, -0.8, 1.2, 0.4, 0.7, 0.2;
  Poses poses{arm.group().fk(q), arm.group().fk(q)};
  poses[1].translation() += Eigen::Vector3d(0, 0.05, 0.05);
  World world;
  Pose at = Pose::Identity();
  at.translation() = poses[0].translation();
  world.add("ball", Sphere{0.05}, at);
  CollisionChecker checker(arm.group(), world);
  for (const bool with_near : {false, true}) {
    const CartesianResult result =
        plan_cartesian(checker, poses, with_near ? std::optional<VectorXd>(q) : std::nullopt);
    EXPECT_EQ(result.outcome, Outcome::invalid_start);
    EXPECT_EQ(result.branches, 0);
    EXPECT_EQ(result.cause, Rejection::scene);
    ASSERT_TRUE(result.contact);
    EXPECT_EQ(result.contact->b, "ball");
    EXPECT_TRUE(result.contact->with_scene);
    EXPECT_EQ(result.beyond_limits, "");
  }
}

TEST(Cartesian, AStartBeyondLimitsIsReportedByJointValueAndLimits) {
  // Bent either way, the elbow is bent further than it may be.
  const test::PumaArm arm(0.3);
  CollisionChecker checker(arm.group(), World{});
  VectorXd q(6);
  q << 0.3, -0.8, 1.2, 0.4, 0.7, 0.2;
  Poses poses{arm.group().fk(q), arm.group().fk(q)};
  poses[1].translation() -= Eigen::Vector3d(0, 0, 0.02);
  const CartesianResult result = plan_cartesian(checker, poses, q);
  EXPECT_EQ(result.outcome, Outcome::invalid_start);
  EXPECT_EQ(result.cause, Rejection::limits);
  EXPECT_GT(result.rejections.limits, 0u);
  EXPECT_FALSE(result.contact);
  for (const char* word : {"j3", "1.2", "[-0.3, 0.3]"})
    EXPECT_NE(result.beyond_limits.find(word), std::string::npos) << result.beyond_limits;
}

TEST(Cartesian, ANearThatIsThereIsJudgedWhenNoBranchIsFound) {
  const test::PlanarArm arm(5);
  CartesianOptions options;
  options.line.ik.max_iterations = 1;  // Inverse kinematics gets nowhere.
  options.line.ik.restarts = 0;
  World world;
  VectorXd beyond(5), touching(5);
  beyond << 2.9, -0.4, 0.3, 0.2, 0.5;
  touching << 0.3, -0.4, 0.3, 0.2, 0.5;
  const Pose at = arm.group().fk(touching);
  world.add("ball", Sphere{0.05}, at);
  CollisionChecker checker(arm.group(), world);
  for (const VectorXd& near : {beyond, touching}) {
    Poses poses{arm.group().fk(near), arm.group().fk(near)};
    poses[1].translation() *= 0.9;
    const CartesianResult unknown = plan_cartesian(checker, poses, std::nullopt, options);
    ASSERT_EQ(unknown.cause, Rejection::unreachable);
    EXPECT_EQ(unknown.outcome, Outcome::not_found);
    const CartesianResult result = plan_cartesian(checker, poses, near, options);
    EXPECT_EQ(result.outcome, Outcome::invalid_start);
    const bool is_beyond = near == beyond;
    EXPECT_EQ(result.cause, is_beyond ? Rejection::limits : Rejection::scene);
    EXPECT_EQ(result.contact ? result.contact->b : "", is_beyond ? "" : "ball");
    for (const char* word : {"j1", "2.9", "[-2.8, 2.8]"})
      EXPECT_EQ(result.beyond_limits.find(word) != std::string::npos, is_beyond) << result.beyond_limits;
  }
}

TEST(Cartesian, FollowsNothingMoreOnceStopped) {
  const test::PumaArm arm;
  CollisionChecker checker(arm.group(), World{});
  VectorXd q(6);
  q << 0.3, -0.8, 1.2, 0.4, 0.7, 0.2;
  Poses poses{arm.group().fk(q), arm.group().fk(q)};
  poses[1].translation() += Eigen::Vector3d(0, 0.05, 0.05);
  ASSERT_GT(plan_cartesian(checker, poses).tried, 2);
  int reports = 0;
  std::size_t queries = 0;
  Monitor monitor;
  monitor.progress = [&](const std::string& stage, double) {
    if (stage != "cartesian path") return;
    ++reports;
    queries = checker.queries();
    monitor.stop.stop();
  };
  const CartesianResult result = plan_cartesian(checker, poses, std::nullopt, {}, monitor);
  EXPECT_EQ(result.outcome, Outcome::stopped);
  EXPECT_FALSE(result.path);
  EXPECT_TRUE(result.corners.empty());
  EXPECT_EQ(result.tried, 1);
  EXPECT_EQ(reports, 1);
  EXPECT_EQ(checker.queries(), queries);
}

TEST(Cartesian, StopsWithinALine) {
  const test::PumaArm arm;
  CollisionChecker checker(arm.group(), World{});
  VectorXd q(6);
  q << 0.3, -0.8, 1.2, 0.4, 0.7, 0.2;
  Poses poses{arm.group().fk(q), arm.group().fk(q)};
  poses[1].translation() += Eigen::Vector3d(0, 0.05, 0.05);
  CartesianOptions options;
  options.line.position_step = 1e-12;  // Hours for one line.
  Monitor monitor;
  std::thread stopper([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
    monitor.stop.stop();
  });
  EXPECT_EQ(plan_cartesian(checker, poses, q, options, monitor).outcome, Outcome::stopped);
  stopper.join();
}

TEST(Cartesian, RefusesBadInput) {
  const test::PumaArm arm;
  CollisionChecker checker(arm.group(), World{});
  const VectorXd q = VectorXd::Zero(6);
  Poses poses{arm.group().fk(q)};
  EXPECT_THROW(plan_cartesian(checker, poses), InvalidInput);
  poses.push_back(poses[0]);
  EXPECT_THROW(plan_cartesian(checker, poses, VectorXd(VectorXd::Zero(5))), InvalidInput);
  CartesianOptions options;
  options.max_branches = 0;
  EXPECT_THROW(plan_cartesian(checker, poses, q, options), InvalidInput);
  poses[1].linear()(0, 0) = 3;
  EXPECT_THROW(plan_cartesian(checker, poses, q), InvalidInput);
}

}  // namespace
}  // namespace mmgrasp
