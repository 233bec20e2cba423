#include <gtest/gtest.h>

#include <cmath>

#include "mmgrasp/verify/plan_check.hpp"
#include "verify/spoiled_plan.hpp"
#include "verify/tiny_world.hpp"

// Plans of a robot without a bin: each part rides to the goal in the hand and is let go there.
namespace tiny {
namespace {

constexpr int kStowed = 3, kTransferred = 4;  // motions of such picks

double from_rest_to_rest(double way, double speed, double acceleration) {
  return way < speed * speed / acceleration ? 2 * std::sqrt(way / acceleration) : way / speed + speed / acceleration;
}

CheckedLegValues values_of(const PlanToCheck& plan, const std::vector<Eigen::Vector3d>& poses) {
  const mmgrasp::BaseLimits& limits = plan.robot.base_limits;
  CheckedLegValues values;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const double way = (poses[i] - poses[i - 1]).head<2>().norm(), turn = std::abs(poses[i].z() - poses[i - 1].z());
    values.length += way;
    values.turning += turn;
    values.duration += way > 0 ? from_rest_to_rest(way, limits.linear_velocity, limits.linear_acceleration)
                               : from_rest_to_rest(turn, limits.angular_velocity, limits.angular_acceleration);
  }
  return values;
}

CheckedUnloading unloading(const PlanToCheck& plan, int after_pick, bool returns) {
  const Eigen::Vector3d &a = plan.stops[0].pose, &goal = plan.goal, quarter(0, 0, M_PI / 2);
  const Eigen::Vector3d corner(goal.x(), a.y(), 0);
  CheckedUnloading trip{after_pick, {a, corner, corner + quarter, goal + quarter, goal}, {}, {}};
  if (returns) trip.back = {trip.to_goal.rbegin(), trip.to_goal.rend()};
  trip.to_goal_values = values_of(plan, trip.to_goal);
  trip.back_values = values_of(plan, trip.back);
  return trip;
}

/// The good plan without its bin, unloaded over a rectangle of 0.2 m in front of the goal.
PlanToCheck carried_plan() {
  PlanToCheck plan = good_plan();
  const Pose T_world_region = at(plan.goal.x() + 0.5, plan.goal.y(), kBinTop);
  plan.unload_region = CheckedUnloadRegion{T_world_region, {0.2, 0.2}, kDropHeight};
  const Eigen::VectorXd release =
      over(plan.goal, T_world_region.translation() + (kDropHeight + 0.5 * kCube) * Eigen::Vector3d::UnitZ());
  for (CheckedPick& pick : plan.picks) {
    const double width = pick.motions[kLift].opening, wide = pick.motions[kTransit].opening;
    const Eigen::VectorXd lifted = pick.motions[kLift].positions.back();
    pick.motions.resize(kStowed);
    pick.motions.push_back(straight("stow", lifted, plan.home, width, true));
    pick.motions.push_back(straight("transfer", plan.home, release, width, true));
    pick.motions.push_back(straight("retreat", release, plan.home, wide, false));
  }
  plan.unloadings = {unloading(plan, 0, true), unloading(plan, 1, false)};
  plan.route[1] = {plan.goal, plan.stops[1].pose};
  return plan;
}

/// A bar across the hand beside the part, clear of the fingers.
void add_bar(PlanToCheck& plan, int part, double half_length) {
  mmgrasp::LinkShape bar = box_shape(0.02, 2 * half_length, kCube);
  bar.T_link_shape = at(0.5 * kCube + 0.01, 0, 0);
  plan.parts[part].body.shapes.push_back(bar);
}

TEST(PlanCheckCarried, PartsRideToTheGoalInTheHand) {
  const PlanCheckResult result = check_plan(carried_plan(), quick());
  EXPECT_TRUE(result.faults.empty()) << listed(result);
}

TEST(PlanCheckCarried, EveryPartIsBroughtToTheGoalByItself) {
  PlanToCheck plan = carried_plan();
  plan.unloadings.clear();
  EXPECT_TRUE(codes_of(plan).count("capacity"));
  plan = carried_plan();
  plan.unloadings.erase(plan.unloadings.begin());
  EXPECT_EQ(codes_of(plan), Codes{"capacity"});
  plan = carried_plan();
  plan.unloadings[0].back.clear();
  EXPECT_EQ(codes_of(plan), Codes{"route-ends"});
  plan = carried_plan();
  plan.capacity = 2;
  EXPECT_EQ(codes_of(plan), Codes{"malformed"});
}

TEST(PlanCheckCarried, PartsAreLetGoOverTheRegionAtTheGoal) {
  PlanToCheck plan = carried_plan();
  plan.unload_region->T_world_region.translation().y() += 0.11;
  EXPECT_EQ(codes_of(plan), Codes{"release-outside"});
  plan = carried_plan();
  plan.unload_region->T_world_region.translation().z() += 0.01;
  EXPECT_EQ(codes_of(plan), Codes{"release-height"});
  plan = carried_plan();
  plan.obstacles.push_back(box("chute", {0.2, 0.2, 0.06}, plan.unload_region->T_world_region * at(0, 0, 0.02)));
  EXPECT_EQ(codes_of(plan), Codes{"scene-collision"}) << "what stands at the goal is an obstacle of its own";
  plan = carried_plan();
  plan.unload_region->size.x() = 0;
  EXPECT_EQ(codes_of(plan), Codes{"malformed"});
  plan = carried_plan();
  plan.unload_region->T_world_region.rotate(Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX()));
  EXPECT_EQ(codes_of(plan), Codes{"malformed"});
}

TEST(PlanCheckCarried, TheArmDrivesAtHome) {
  PlanToCheck plan = carried_plan();
  plan.picks[0].motions.erase(plan.picks[0].motions.begin() + kStowed);
  EXPECT_EQ(codes_of(plan), Codes{"motion-order"});
  plan = carried_plan();
  plan.picks[0].motions[kStowed].attached = false;
  EXPECT_EQ(codes_of(plan), Codes{"attachment"});
  plan = carried_plan();
  const Eigen::VectorXd aside = plan.home + joints(0.05, 0, 0);
  for (const int pick : {0, 1, 2}) {
    CheckedMotion &stow = motion(plan, pick, kStowed), &transfer = motion(plan, pick, kTransferred);
    stow = straight("stow", stow.positions.front(), aside, stow.opening, true);
    transfer = straight("transfer", aside, transfer.positions.back(), transfer.opening, true);
  }
  EXPECT_EQ(codes_of(plan), Codes{"discontinuous"});
  plan = carried_plan();
  plan.unload_region.reset();
  EXPECT_TRUE(codes_of(plan).count("motion-order"));
}

TEST(PlanCheckCarried, TheHeldPartMustPassWhereTheRobotDoes) {
  // Two posts between stop 1 and the goal, 0.5 m apart: the base is 0.4 m wide, the bar that it brings 0.6 m.
  const auto between_posts = [](PlanToCheck plan, double half_bar) {
    add_bar(plan, 3, half_bar);
    for (const double side : {-0.3, 0.3})
      plan.obstacles.push_back(box(side < 0 ? "post" : "other post", {0.1, 0.1, 1.4}, at(-0.3, 3 + side, 0.7)));
    return codes_of(plan);
  };
  EXPECT_EQ(between_posts(carried_plan(), 0.3), Codes{"route-collision"});
  EXPECT_EQ(between_posts(carried_plan(), 0.24), Codes{});
  EXPECT_EQ(between_posts(good_plan(), 0.3), Codes{}) << "in the bin";
}

TEST(PlanCheckCarried, PartsStillInPlaceAreInTheWayOfAHeldOne) {
  PlanToCheck plan = carried_plan();
  add_bar(plan, 0, 0.09);
  plan.parts[2].body.T_world_body = at(-1, 1.5, 1.18);  // it stays, hanging in the air beside the way to the goal
  plan.parts[2].body.T_world_body.translation().x() += 0.09;
  EXPECT_EQ(codes_of(plan), Codes{"route-collision"});
  plan.parts[2].body.T_world_body.translation().x() += 0.05;
  EXPECT_EQ(codes_of(plan), Codes{});
}

TEST(PlanCheckCarried, TheHeldPartKeepsTheDriveClearance) {
  PlanToCheck plan = carried_plan();
  add_bar(plan, 1, 0.08);
  const double lamp = plan.goal.x() + 0.08 + 0.10 + 0.025;
  plan.obstacles.push_back(box("lamp", {0.05, 0.05, 0.04}, at(lamp, 1.5, plan.home[0] + 0.9 - kHandAbove)));
  plan.drive_clearance = 0.099;
  EXPECT_EQ(codes_of(plan), Codes{});
  plan.drive_clearance = 0.101;
  EXPECT_EQ(codes_of(plan), Codes{"route-clearance"});
}

TEST(PlanCheckCarried, NothingIsTakenInPassing) {
  PlanToCheck plan = carried_plan();
  plan.drive_by.push_back({0, 0.1, 0.2, motion(plan, 0, kTransit)});
  EXPECT_EQ(codes_of(plan), Codes{"malformed"});
}

}  // namespace
}  // namespace tiny
