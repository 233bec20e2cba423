#include <gtest/gtest.h>

#include "mmgrasp/verify/plan_check.hpp"
#include "verify/spoiled_plan.hpp"

// Limits, times and continuity of a plan's arm motions.
namespace tiny {
namespace {

TEST(PlanCheck, MovedJointBreaksLimits) {
  PlanToCheck plan = good_plan();
  motion(plan, 0, kTransit).positions[10][1] += 0.02;
  EXPECT_TRUE(codes_of(plan).count("acceleration-limit"));
}

TEST(PlanCheck, PositionLimit) {
  PlanToCheck plan = good_plan();
  for (Eigen::VectorXd& q : motion(plan, 1, kTransfer).positions) q[4] += 3.2;
  EXPECT_TRUE(codes_of(plan).count("position-limit"));
}

TEST(PlanCheck, PositionLimitBetweenSamples) {
  // Both samples are inside, the cubic between them swings to 0.5 + 0.25 * v * h: out of the z joint's 0.5.
  PlanToCheck plan = good_plan();
  CheckedMotion& m = motion(plan, 0, kTransit);
  m.times = {0, 1};
  m.positions = {joints(0.49, 0, 0), joints(0.49, 0, 0)};
  m.velocities = {joints(0.5, 0, 0), joints(-0.5, 0, 0)};
  EXPECT_TRUE(codes_of(plan).count("position-limit"));
}

TEST(PlanCheck, VelocityLimit) {
  PlanToCheck plan = good_plan();
  CheckedMotion& m = motion(plan, 0, kTransit);
  for (double& t : m.times) t *= 0.5;
  for (Eigen::VectorXd& v : m.velocities) v *= 2;
  EXPECT_TRUE(codes_of(plan).count("velocity-limit"));
}

TEST(PlanCheck, AccelerationLimitOnly) {
  PlanToCheck plan = good_plan();
  plan.acceleration_limits.assign(5, 1.0);
  EXPECT_EQ(codes_of(plan), Codes{"acceleration-limit"});
}

TEST(PlanCheck, AccelerationIsTheLeastThatJoinsTheSamples) {
  // From rest to rest over d in T under |a| <= A the shortest time is 2 sqrt(d / A): A = 4 d / T^2 is just enough.
  PlanToCheck plan = good_plan();
  CheckedMotion& m = motion(plan, 0, kLift);
  const double T = 1.0, needed = 4 * 0.12 / (T * T);
  m.times = {0, T};
  m.positions = {m.positions.front(), m.positions.back()};
  m.velocities = {joints(0, 0, 0), joints(0, 0, 0)};
  const auto lift_fails = [&] {
    for (const Fault& fault : check_plan(plan, quick()).faults) {
      if (fault.code == "acceleration-limit" && fault.where.find("pick 0 (A/cube_0), lift") == 0) return true;
    }
    return false;
  };
  plan.acceleration_limits.assign(5, needed * 1.02);
  EXPECT_FALSE(lift_fails());
  plan.acceleration_limits.assign(5, needed * 0.98);
  EXPECT_TRUE(lift_fails());
}

TEST(PlanCheck, TimesMustIncrease) {
  PlanToCheck plan = good_plan();
  std::swap(motion(plan, 0, kLift).times[3], motion(plan, 0, kLift).times[4]);
  EXPECT_EQ(codes_of(plan), Codes{"times"});
}

TEST(PlanCheck, DiscontinuousMotion) {
  PlanToCheck plan = good_plan();
  const Eigen::VectorXd shifted = joints(0.3, 0.001, 0);
  motion(plan, 0, kTransit) = straight("transit", shifted, motion(plan, 0, kTransit).positions.back(), 0.06, false);
  EXPECT_EQ(codes_of(plan), Codes{"discontinuous"});
  plan = good_plan();
  motion(plan, 2, kRetreat) = straight("retreat", motion(plan, 2, kRetreat).positions.front(), shifted, 0.06, false);
  EXPECT_EQ(codes_of(plan), Codes{"discontinuous"});
}

/// The gantry with a yaw that turns without end.
PlanToCheck endless_yaw_plan() {
  std::string text = replaced(urdf(), "\"yaw\" type=\"revolute\"", "\"yaw\" type=\"continuous\"");
  return on_other_robot(good_plan(), replaced(text, "lower=\"-3.1\" upper=\"3.1\" ", ""), srdf());
}

void turn_yaw(CheckedMotion& motion, double by) {
  for (Eigen::VectorXd& q : motion.positions) q[4] += by;
}

TEST(PlanCheck, WholeTurnsBetweenMotionsAreSteps) {
  EXPECT_EQ(codes_of(endless_yaw_plan()), Codes{});
  for (int pick = 0; pick < 3; ++pick) {
    for (const int kind : {kTransit, kApproach, kLift, kTransfer, kRetreat}) {
      PlanToCheck plan = endless_yaw_plan();
      turn_yaw(motion(plan, pick, kind), 2 * M_PI);
      EXPECT_EQ(codes_of(plan), Codes{"discontinuous"}) << pick << " " << kind;
    }
  }
  PlanToCheck plan = endless_yaw_plan();
  for (CheckedMotion& m : plan.picks[1].motions) turn_yaw(m, -2 * M_PI);  // the arm's numbers persist over the drive
  EXPECT_EQ(codes_of(plan), Codes{"discontinuous"});
}

TEST(PlanCheck, HomeMayBeWholeTurnsAway) {
  PlanToCheck plan = endless_yaw_plan();
  for (CheckedPick& pick : plan.picks) {
    for (CheckedMotion& m : pick.motions) turn_yaw(m, 4 * M_PI);
  }
  EXPECT_EQ(codes_of(plan), Codes{});
  for (CheckedPick& pick : plan.picks) {
    for (CheckedMotion& m : pick.motions) turn_yaw(m, 0.1);
  }
  EXPECT_TRUE(codes_of(plan).count("discontinuous"));
}

TEST(PlanCheck, VelocityLimitAboveTheRobots) {
  PlanToCheck plan = good_plan();
  plan.velocity_limits[3] = 1.001;  // the URDF says 1
  EXPECT_EQ(codes_of(plan), Codes{"limit-exceeds-robot"});
  plan.velocity_limits[3] = 0.999;
  plan.acceleration_limits[3] = 1e3;
  EXPECT_EQ(codes_of(plan), Codes{});
}

TEST(PlanCheck, NotAtRestWhereFingersMove) {
  PlanToCheck plan = good_plan();
  motion(plan, 0, kApproach).velocities.back()[0] = -0.01;
  EXPECT_TRUE(codes_of(plan).count("not-at-rest"));
}

}  // namespace
}  // namespace tiny
