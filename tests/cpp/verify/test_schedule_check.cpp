#include "mmgrasp/verify/schedule_check.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "verify/spoiled_plan.hpp"

// The gantry beside another one on the same clock: what the base, the arm and the cube in its hand come near to.
namespace tiny {
namespace {

using Eigen::Vector3d;

/// Seconds from rest to rest at the default limits (0.6 m/s, 0.5 m/s^2).
double drive_time(double way) {
  return way / 0.6 + 0.6 / 0.5;
}

/// A gantry that drives straight along x, from rest to rest; no picks.
PlanToCheck driving(double y, double from, double to) {
  PlanToCheck plan = empty_plan(0.1, good_plan().grid);
  plan.start = {from, y, 0};
  plan.goal = {to, y, 0};
  plan.route = {{plan.start, plan.goal}};
  return plan;
}

/// The good plan's first stop with its first cube: the base stands there all along.
PlanToCheck picking() {
  PlanToCheck plan = good_plan();
  plan.start = plan.goal = plan.stops[0].pose;
  plan.stops.resize(1);
  plan.picks.resize(1);
  plan.route = {{plan.start}, {plan.goal}};
  return plan;
}

/// One piece after the other, fingers included.
std::vector<double> starts_of_the_pick(const PlanToCheck& plan) {
  std::vector<double> starts;
  double time = 0;
  const auto lasts = [&](double seconds) {
    starts.push_back(time);
    time += seconds;
  };
  for (std::size_t i = 0; i < plan.picks[0].motions.size(); ++i) {
    if (i == kLift || i == kRetreat) lasts(0.02 / plan.closing_speed);
    lasts(plan.picks[0].motions[i].times.back());
  }
  return starts;
}

std::string codes_of(const std::vector<ScheduledPlan>& robots, double clearance = 0.1) {
  std::string out;
  for (const Fault& fault : check_schedule(robots, clearance)) out += fault.code + " ";
  return out;
}

TEST(ScheduleCheck, FollowersKeepTheDistanceThatTheirDelaySays) {
  // Bodies of 0.4 m one behind the other, both 3 m along x; at rest the middles are 0.8 m apart, so 0.4 m are free.
  const PlanToCheck first = driving(0, 0, 3), second = driving(0, -0.8, 2.2);
  EXPECT_EQ(codes_of({{first, {0}}, {second, {0}}}, 0.4), "");
  EXPECT_EQ(codes_of({{first, {0}}, {second, {0}}}, 0.405), "robots-meet ");
  EXPECT_EQ(codes_of({{first, {0}}, {second, {1}}}, 0.4), "");
  // Half a second late at 0.6 m/s, the first one is nearer by 0.3 m.
  EXPECT_EQ(codes_of({{first, {0.3 / 0.6}}, {second, {0}}}, 0.105), "robots-meet ");
  EXPECT_EQ(codes_of({{first, {0.3 / 0.6}}, {second, {0}}}, 0.1), "");
}

TEST(ScheduleCheck, RobotsStandBeforeTheyStartAndAfterTheirEnd) {
  const PlanToCheck first = driving(0, 0, 3);
  EXPECT_EQ(codes_of({{first, {0}}, {driving(0.45, 8, 3), {0}}}), "robots-meet ");
  EXPECT_EQ(codes_of({{first, {0}}, {driving(0.55, 8, 3), {0}}}), "");
  EXPECT_EQ(codes_of({{first, {30}}, {driving(0.45, 8, -8), {0}}}), "robots-meet ");
}

TEST(ScheduleCheck, ArmsCountWhereBasesAreClear) {
  // Bases are 0.05 m apart; the hand of the first comes to where the other one's hand is.
  const PlanToCheck first = picking();
  const double x = first.start.x() + 0.45;
  PlanToCheck second = driving(0, x, x + 0.001);
  second.home = joints(-0.36, 0, 0);
  const std::vector<double> starts{0};
  EXPECT_EQ(codes_of({{first, starts_of_the_pick(first)}, {second, starts}}, 0.01), "robots-meet ");
  PlanToCheck still = first;
  still.picks.clear();
  still.stops.clear();
  still.route = {{still.start, still.start - Vector3d(0.001, 0, 0)}};
  EXPECT_EQ(codes_of({{still, {0}}, {second, starts}}, 0.01), "");
}

TEST(ScheduleCheck, PiecesAreCountedAndBeginWhenTheRobotIsReady) {
  const PlanToCheck plan = picking(), other = driving(30, 0, 3);
  std::vector<double> starts = starts_of_the_pick(plan);
  ASSERT_EQ(starts.size(), 7u);
  EXPECT_EQ(codes_of({{plan, starts}, {other, {0}}}), "");
  EXPECT_EQ(codes_of({{plan, starts}, {other, {0}, {drive_time(3)}}}), "");
  EXPECT_EQ(codes_of({{plan, starts}, {other, {0}, {drive_time(3) + 0.01}}}), "piece-duration ");
  EXPECT_EQ(codes_of({{plan, starts}, {other, {0, 10}}}), "schedule-pieces ");
  starts[3] -= 0.01;
  EXPECT_EQ(codes_of({{plan, starts}, {other, {0}}}), "too-early ");
  starts[3] = std::nan("");
  EXPECT_EQ(codes_of({{plan, starts}, {other, {0}}}), "too-early ");
}

TEST(ScheduleCheck, BrokenPlansAreFaultsAndBadClearancesThrow) {
  PlanToCheck broken = picking();
  broken.picks[0].motions[1].times[2] = -1;
  EXPECT_EQ(codes_of({{broken, starts_of_the_pick(picking())}, {driving(30, 0, 3), {0}}}), "malformed ");
  broken = driving(0, 0, 3);
  broken.tip_link = "nobody";
  EXPECT_EQ(codes_of({{broken, {0}}, {driving(30, 0, 3), {0}}}), "malformed ");
  for (const double clearance : {0.0, 11.0, std::nan("")})
    EXPECT_THROW(check_schedule({{driving(0, 0, 3), {0}}}, clearance), mmgrasp::InvalidInput);
}

TEST(ScheduleCheck, Stops) {
  mmgrasp::Monitor monitor;
  monitor.stop.stop();
  const auto faults = check_schedule({{driving(0, 0, 3), {0}}, {driving(9, 0, 3), {0}}}, 0.1, monitor);
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_EQ(faults[0].code, "stopped");
}

}  // namespace
}  // namespace tiny
