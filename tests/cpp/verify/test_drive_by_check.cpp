#include <gtest/gtest.h>

#include <cmath>

#include "mmgrasp/verify/plan_check.hpp"
#include "verify/spoiled_plan.hpp"

// Parts taken in passing: the gantry drives to its first stop and takes the first cube on the way, by hand.
namespace tiny {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

VectorXd row(double base_x, const VectorXd& arm) {
  VectorXd q(3 + arm.size());
  q << base_x, 0, 0, arm;
  return q;
}

/// Goes on to `to` along 3 u^2 - 2 u^3 within a time.
void go_on(CheckedMotion& motion, const VectorXd& to, double duration) {
  constexpr int kSamples = 100;
  const VectorXd from = motion.positions.back(), d = to - from;
  const double begin = motion.times.back();
  for (int i = 1; i <= kSamples; ++i) {
    const double u = static_cast<double>(i) / kSamples;
    motion.times.push_back(begin + u * duration);
    motion.positions.push_back(from + (3 * u * u - 2 * u * u * u) * d);
    motion.velocities.push_back((6 * u - 6 * u * u) / duration * d);
  }
}

/// Where the base is when the fingers begin to close and when they hold.
constexpr double kAtClosing = 0.2, kAtHold = 0.3;

/// `follows`: the arm makes up for the base while the fingers close.
PlanToCheck passing_plan(double follows = 1, double duration_scale = 1) {
  PlanToCheck plan = good_plan();
  const Vector3d up = Vector3d::UnitZ(), grasp = plan.parts[0].body.T_world_body.translation();
  const auto at = [](double x) { return Vector3d(x, 0, 0); };
  CheckedDriveBy passing;
  passing.pick = 0;
  CheckedMotion& m = passing.motion;
  m.kind = "drive-by";
  m.opening = plan.parts[0].grasps[0].opening + 0.02;
  m.times = {0};
  m.positions = {row(plan.start.x(), plan.home)};
  m.velocities = {VectorXd::Zero(8)};
  go_on(m, row(kAtClosing, over(at(kAtClosing), grasp + 0.08 * up)), 4 * duration_scale);
  go_on(m, row(kAtClosing, over(at(kAtClosing), grasp)), duration_scale);
  passing.close_at = m.times.back();
  const Vector3d where = at(kAtClosing + follows * (kAtHold - kAtClosing));
  go_on(m, row(kAtHold, over(where, grasp)), 1.2 * duration_scale);
  passing.closed_at = m.times.back();
  go_on(m, row(plan.stops[0].pose.x(), over(plan.stops[0].pose, grasp + 0.12 * up)), 1.2 * duration_scale);
  plan.drive_by = {passing};
  return plan;
}

TEST(DriveByCheck, AGoodOneHasNoFault) {
  const PlanCheckResult result = check_plan(passing_plan(), quick());
  EXPECT_TRUE(result.faults.empty()) << listed(result);
}

TEST(DriveByCheck, TheHandMustKeepItsPlaceWhileTheFingersClose) {
  EXPECT_TRUE(codes_of(passing_plan(0)).count("grasp-missed"));
  EXPECT_TRUE(codes_of(passing_plan(0.9)).count("grasp-missed"));    // 1 cm
  EXPECT_FALSE(codes_of(passing_plan(0.99)).count("grasp-missed"));  // 1 mm
}

TEST(DriveByCheck, LimitsOfBaseAndWheels) {
  EXPECT_TRUE(codes_of(passing_plan(1, 0.5)).count("base-limit"));
  PlanToCheck plan = passing_plan();
  mmgrasp::RobotOptions options;
  options.base = mmgrasp::BaseKind::diff_drive;
  options.base_limits.wheel_velocity = 0.4;  // the base comes at 0.45 m/s
  plan.robot = mmgrasp::source_of(mmgrasp::Robot::from_strings(urdf(), srdf(), options));
  EXPECT_EQ(codes_of(plan), Codes{"wheel-limit"});
}

/// The plan's robot on four Mecanum wheels whose rims run at `rim`.
void put_on_mecanum(PlanToCheck& plan, double rim) {
  mmgrasp::RobotOptions options;
  options.base = mmgrasp::BaseKind::omni;
  options.base_limits.wheel_velocity = rim;
  options.base_limits.wheel_separation = 0.4;
  options.base_limits.wheelbase = 0.5;
  plan.robot = mmgrasp::source_of(mmgrasp::Robot::from_strings(urdf(), srdf(), options));
}

TEST(DriveByCheck, MecanumWheelsThatTurnTooFast) {
  // Straight ahead all four run at the base's speed, 1.5 times the mean of 1.2 m in 4 s.
  PlanToCheck plan = passing_plan();
  put_on_mecanum(plan, 0.45);
  EXPECT_EQ(codes_of(plan), Codes{});
  PlanToCheck faster = passing_plan(1, 1 / 1.01);
  put_on_mecanum(faster, 0.45);
  EXPECT_EQ(codes_of(faster), Codes{"wheel-limit"});
}

TEST(DriveByCheck, MecanumWheelsOfABaseThatDrivesAndTurns) {
  // At 0.3 m/s along x, turning at 0.5 rad/s: at 45 degrees, which lies between two samples, the fastest rim runs at
  // 0.3 sqrt(2) + 0.5 x 0.45 m/s.
  PlanToCheck plan = passing_plan();
  CheckedMotion& m = plan.drive_by[0].motion;
  m.times.clear();
  m.positions.clear();
  m.velocities.clear();
  const double rate = 0.5, end = M_PI / 2 / rate;
  for (int i = 0; i <= 5; ++i) {
    const double t = end * i / 5;
    VectorXd v = VectorXd::Zero(8);
    v.head<3>() << 0.3, 0, rate;
    m.times.push_back(t);
    m.positions.push_back(row(0, plan.home) + t * v);
    m.velocities.push_back(v);
  }
  const double fastest = 0.3 * std::sqrt(2.0) + rate * 0.45;
  put_on_mecanum(plan, fastest);
  EXPECT_FALSE(codes_of(plan).count("wheel-limit"));
  put_on_mecanum(plan, fastest / 1.01);
  EXPECT_TRUE(codes_of(plan).count("wheel-limit"));
}

TEST(DriveByCheck, ABaseThatDoesNotGoWhereItsVelocitiesLead) {
  PlanToCheck slid = passing_plan(), drawn = passing_plan();
  const double end = slid.drive_by[0].motion.times.back();
  for (std::size_t i = 0; i < slid.drive_by[0].motion.times.size(); ++i) {
    const double t = slid.drive_by[0].motion.times[i];
    // Half a centimetre to the side and back: with the velocities of that, and without.
    for (PlanToCheck* plan : {&slid, &drawn})
      plan->drive_by[0].motion.positions[i][1] += 0.005 * (1 - std::cos(2 * M_PI * t / end)) / 2;
    slid.drive_by[0].motion.velocities[i][1] += 0.005 * M_PI / end * std::sin(2 * M_PI * t / end);
  }
  EXPECT_TRUE(codes_of(slid).count("base-off-course"));
  EXPECT_TRUE(codes_of(drawn).count("base-off-course"));
}

TEST(DriveByCheck, AccelerationsAreThoseOfTheVelocities) {
  PlanToCheck good = passing_plan();
  CheckedMotion& motion = good.drive_by[0].motion;
  for (std::size_t i = 0; i + 1 < motion.times.size(); ++i)
    motion.accelerations.push_back((motion.velocities[i + 1] - motion.velocities[i]) /
                                   (motion.times[i + 1] - motion.times[i]));
  motion.accelerations.push_back(motion.accelerations.back());
  EXPECT_EQ(codes_of(good), Codes{});
  for (const int column : {0, 2, 5}) {
    PlanToCheck lie = good;
    lie.drive_by[0].motion.accelerations[50][column] += 0.4;
    EXPECT_EQ(codes_of(lie), Codes{"acceleration"}) << column;
    for (VectorXd& a : lie.drive_by[0].motion.accelerations) a[column] = 0.4;
    EXPECT_EQ(codes_of(lie), Codes{"acceleration"}) << column;
  }
  PlanToCheck lie = good;
  lie.drive_by[0].motion.velocities[50][5] += 0.05;
  EXPECT_TRUE(codes_of(lie).count("acceleration"));
  good.drive_by[0].motion.accelerations.pop_back();
  EXPECT_TRUE(codes_of(good).count("acceleration"));
}

TEST(DriveByCheck, ACurveIsDrivenAsTheWheelsLead) {
  // A quarter circle with linear velocities: exact at any sampling, so that nothing may be said of it.
  PlanToCheck plan = passing_plan();
  CheckedMotion& m = plan.drive_by[0].motion;
  m.times.clear();
  m.positions.clear();
  m.velocities.clear();
  const double radius = 0.5, rate = 0.5, end = M_PI / 2 / rate;
  for (int i = 0; i <= 50; ++i) {
    const double t = end * i / 50, theta = rate * t;
    VectorXd q = row(0, plan.home), v = VectorXd::Zero(8);
    q.head<3>() << radius * std::sin(theta), radius * (1 - std::cos(theta)), theta;
    v.head<3>() << radius * rate * std::cos(theta), radius * rate * std::sin(theta), rate;
    m.times.push_back(t);
    m.positions.push_back(q);
    m.velocities.push_back(v);
  }
  EXPECT_FALSE(codes_of(plan).count("base-off-course"));
  m.positions.back()[0] += 2e-3;
  EXPECT_TRUE(codes_of(plan).count("base-off-course"));
}

TEST(DriveByCheck, WhatItMeetsOnItsWay) {
  // Neither the drive with the arm at home nor the reach at the stop comes here.
  PlanToCheck plan = passing_plan();
  plan.obstacles.push_back(box("sign", {0.1, 0.1, 0.1}, at(0.0, 0.05, 0.9)));
  EXPECT_EQ(codes_of(plan), Codes{"scene-collision"});
  plan.drive_by.clear();
  EXPECT_EQ(codes_of(plan), Codes{});
}

TEST(DriveByCheck, TheClosedHandMustNotComeToThePart) {
  PlanToCheck plan = passing_plan();
  plan.drive_by[0].motion.opening = plan.parts[0].grasps[0].opening - 0.01;
  EXPECT_TRUE(codes_of(plan).count("opening"));
}

TEST(DriveByCheck, FingersNeedTheirTime) {
  PlanToCheck plan = passing_plan();
  plan.drive_by[0].closed_at = plan.drive_by[0].close_at + 0.19;  // 2 cm at 0.1 m/s
  EXPECT_TRUE(codes_of(plan).count("closing-time"));
  plan.drive_by[0].closed_at = plan.drive_by[0].motion.times.back() + 1;
  EXPECT_TRUE(codes_of(plan).count("closing-time"));
}

TEST(DriveByCheck, ItsEndsMeetThePlan) {
  PlanToCheck plan = passing_plan();
  plan.drive_by[0].motion.positions.back()[3] += 1e-3;
  EXPECT_TRUE(codes_of(plan).count("discontinuous"));
  plan = passing_plan();
  plan.drive_by[0].motion.positions.front()[0] += 1e-3;
  EXPECT_TRUE(codes_of(plan).count("route-ends"));
  plan = passing_plan();
  plan.drive_by[0].motion.velocities.back()[4] = 0.1;
  EXPECT_TRUE(codes_of(plan).count("not-at-rest"));
}

/// The arm alone, at the stop: from where cube 0 is let go to cube 1 and on to the bin.
PlanToCheck released_to_released() {
  PlanToCheck plan = good_plan();
  const Vector3d up = Vector3d::UnitZ(), grasp = plan.parts[1].body.T_world_body.translation();
  const Vector3d base = plan.stops[0].pose;
  CheckedDriveBy passing;
  passing.pick = 1;
  passing.from_release = passing.to_release = true;
  CheckedMotion& m = passing.motion;
  m.kind = "drive-by";
  m.opening = plan.parts[1].grasps[0].opening + 0.02;
  m.times = {0};
  m.positions = {row(base.x(), motion(plan, 0, kTransfer).positions.back())};
  m.velocities = {VectorXd::Zero(8)};
  go_on(m, row(base.x(), over(base, grasp + 0.08 * up)), 2);
  go_on(m, row(base.x(), over(base, grasp)), 1);
  passing.close_at = m.times.back();
  go_on(m, row(base.x(), over(base, grasp)), 0.3);
  passing.closed_at = m.times.back();
  go_on(m, row(base.x(), over(base, grasp + 0.12 * up)), 1);
  go_on(m, row(base.x(), motion(plan, 1, kTransfer).positions.back()), 2);
  plan.drive_by = {passing};
  return plan;
}

TEST(DriveByCheck, FromReleaseToRelease) {
  const PlanToCheck good = released_to_released();
  EXPECT_TRUE(check_plan(good, quick()).faults.empty()) << listed(check_plan(good, quick()));
  PlanToCheck plan = good;
  plan.drive_by[0].from_release = false;
  EXPECT_EQ(codes_of(plan), Codes{"drive-by-pick"});
  plan = good;
  plan.drive_by[0].to_release = false;  // it would have to end lifted
  EXPECT_EQ(codes_of(plan), Codes{"discontinuous"});
  plan = good;
  plan.drive_by[0].pick = 0;
  EXPECT_EQ(codes_of(plan), Codes{"drive-by-pick"});
  plan = good;
  plan.drive_by[0].motion.positions.front()[4] += 1e-3;
  EXPECT_TRUE(codes_of(plan).count("discontinuous"));
  for (const std::size_t end : {std::size_t{0}, good.drive_by[0].motion.times.size() - 1}) {
    plan = good;
    plan.drive_by[0].motion.positions[end][0] += 1e-3;
    EXPECT_TRUE(codes_of(plan).count("route-ends")) << end;
  }
}

TEST(DriveByCheck, WhatIsHeldOnTheWayToTheBin) {
  // Beside the way of pick 1's own motions, which keep to other places.
  PlanToCheck plan = released_to_released();
  CheckedMotion& m = plan.drive_by[0].motion;
  const auto middle =
      std::upper_bound(m.times.begin(), m.times.end(), plan.drive_by[0].closed_at + 2) - m.times.begin();
  const VectorXd q = m.positions[middle];
  // Below the fingers, where only the cube comes.
  plan.obstacles.push_back(box("post", {0.01, 0.01, 0.01}, at(q[0] + 0.1 + q[4], q[5], 0.9 + q[3] - 0.043)));
  EXPECT_TRUE(codes_of(plan).count("attached-collision")) << listed(check_plan(plan, quick()));
}

TEST(DriveByCheck, OnlyTheFirstPickOfAStopAndOnce) {
  for (const int pick : {-1, 1, 3}) {
    PlanToCheck plan = passing_plan();
    plan.drive_by[0].pick = pick;
    EXPECT_TRUE(codes_of(plan).count("drive-by-pick")) << pick;
  }
  PlanToCheck plan = passing_plan();
  plan.drive_by.push_back(plan.drive_by[0]);
  EXPECT_EQ(codes_of(plan), Codes{"drive-by-pick"});
}

TEST(DriveByCheck, NumbersThatAreNone) {
  PlanToCheck plan = passing_plan();
  plan.drive_by[0].motion.positions[5][1] = std::nan("");
  EXPECT_TRUE(codes_of(plan).count("motion-shape"));
  plan = passing_plan();
  plan.drive_by[0].motion.velocities.pop_back();
  EXPECT_TRUE(codes_of(plan).count("motion-shape"));
  plan = passing_plan();
  plan.drive_by[0].close_at = std::nan("");
  EXPECT_TRUE(codes_of(plan).count("closing-time"));
  plan = passing_plan();
  plan.closing_speed = 0;
  EXPECT_EQ(codes_of(plan), Codes{"malformed"});
}

}  // namespace
}  // namespace tiny
