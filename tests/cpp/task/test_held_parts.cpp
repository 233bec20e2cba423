#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/task/part_supply.hpp"
#include "mmgrasp/task/plan_to_check.hpp"
#include "mmgrasp/verify/plan_check.hpp"
#include "support/small_storeroom.hpp"

// A robot without a bin: it brings each part to the goal in its hand and lets it go there.
namespace mmgrasp {
namespace {

const ReachDatabase& database() {
  static const ReachDatabase shared = test::small_database(test::small_storeroom());
  return shared;
}

/// A part of each tray, brought to a region 0.5 m ahead of the goal.
PartSupplyProblem storeroom_without_bin() {
  PartSupplyProblem problem = test::small_storeroom(1);
  problem.unload_region.emplace();
  problem.unload_region->T_world_region = pose_from_planar(problem.goal) * test::at(0.5, 0, 0.45);
  return problem;
}

verify::PlanCheckResult verdict(const PartSupplyProblem& problem, const PartSupplyPlan& plan) {
  verify::PlanCheckOptions options;
  options.samples = 50;
  return verify::check_plan(plan_to_check(problem, plan), options);
}

void expect_good(const PartSupplyProblem& problem, const PartSupplyPlan& plan) {
  ASSERT_EQ(plan.outcome, Outcome::solved)
      << (plan.obstructions.empty() ? std::string() : plan.obstructions.front().message);
  for (const verify::Fault& fault : verdict(problem, plan).faults)
    ADD_FAILURE() << fault.code << ", " << fault.where << ": " << fault.message;
}

TEST(HeldParts, EachIsBroughtToTheGoalByItself) {
  const PartSupplyProblem problem = storeroom_without_bin();
  const PartSupplyPlan plan = plan_part_supply(problem, database());
  expect_good(problem, plan);
  const PartSupplyPlan binned = plan_part_supply(test::small_storeroom(1), database());
  EXPECT_EQ(plan.stops.size(), binned.stops.size()) << "the round is longer, not its stops more";
  EXPECT_EQ(plan.lower_bound, binned.lower_bound);
  ASSERT_EQ(plan.picks.size(), 2u);
  ASSERT_EQ(plan.unloadings.size(), 1u);
  EXPECT_EQ(plan.unloadings[0].after_pick, 0);
  const std::vector<MotionKind> kinds = {MotionKind::transit, MotionKind::approach, MotionKind::lift,
                                         MotionKind::stow,    MotionKind::transfer, MotionKind::retreat};
  for (const Pick& pick : plan.picks) {
    ASSERT_EQ(pick.motions.size(), kinds.size());
    for (std::size_t i = 0; i < kinds.size(); ++i) {
      EXPECT_EQ(pick.motions[i].kind, kinds[i]);
      EXPECT_EQ(pick.motions[i].attached, i >= 2 && i <= 4);
    }
    // By kinematics alone: where the part hangs as it is let go.
    const JointGroup there = problem.arm.at(pose_from_planar(problem.goal));
    const Part& part = problem.trays[pick.part.tray].parts[pick.part.part];
    const Pose T_world_part =
        there.fk(pick.motions[4].trajectory.positions.back()) * part.grasps[pick.grasp].T_object_hand.inverse();
    const Eigen::Vector3d at = problem.unload_region->T_world_region.inverse() * T_world_part.translation();
    EXPECT_LE(at.head<2>().cwiseAbs().maxCoeff(), 0.15);
    EXPECT_NEAR(at.z(), problem.unload_region->drop_height + 0.03, 1e-3) << "half of its height above";
  }
}

TEST(HeldParts, ThePlanIsTheSameAtAnyThreadCount) {
  PartSupplyProblem problem = storeroom_without_bin();
  problem.options.threads = 1;
  const PartSupplyPlan one = plan_part_supply(problem, database());
  problem.options.threads = 3;
  const PartSupplyPlan three = plan_part_supply(problem, database());
  ASSERT_EQ(one.unloadings.size(), three.unloadings.size());
  for (std::size_t i = 0; i < one.unloadings.size(); ++i)
    EXPECT_EQ(one.unloadings[i].to_goal.poses, three.unloadings[i].to_goal.poses);
  ASSERT_EQ(one.picks.size(), three.picks.size());
  for (std::size_t i = 0; i < one.picks.size(); ++i)
    for (std::size_t k = 0; k < one.picks[i].motions.size(); ++k)
      EXPECT_EQ(one.picks[i].motions[k].trajectory.positions, three.picks[i].motions[k].trajectory.positions);
}

/// A bar of 0.7 m that is held across the robot at home, and a goal in a chamber whose door is 0.6 m wide and 0.8 m
/// deep: the base of 0.4 m passes, the bar does not.
PartSupplyProblem chamber(bool wide_door) {
  PartSupplyProblem problem = storeroom_without_bin();
  problem.trays.pop_back();
  Part& bar = problem.trays[0].parts[0];
  bar.shapes[0].shape = test::box_shape(0.03, 0.7, 0.06);
  std::vector<Grasp> grasps;
  for (const Grasp& grasp : bar.grasps) {
    if (std::abs(grasp.T_object_hand.linear()(0, 1)) > 0.99) grasps.push_back(grasp);  // closing along its short side
  }
  bar.grasps = grasps;
  problem.home[5] = M_PI / 2;
  problem.goal = Eigen::Vector3d(-3.4, 0, M_PI);
  problem.unload_region->T_world_region = pose_from_planar(problem.goal) * test::at(0.5, 0, 0.45);
  problem.start = Eigen::Vector3d(-0.6, 0, 0);
  const double height = 1.0, middle = 0.5 * height;
  problem.world.add("front left", test::box_shape(0.8, 1.1, height), test::at(-1.9, 0.85, middle));
  problem.world.add("front right", test::box_shape(0.8, 1.1, height), test::at(-1.9, -0.85, middle));
  problem.world.add("back", test::box_shape(0.1, 2.8, height), test::at(-4.7, 0, middle));
  problem.world.add("side", test::box_shape(3.2, 0.1, height), test::at(-3.1, -1.4, middle));
  if (!wide_door) problem.world.add("other side", test::box_shape(3.2, 0.1, height), test::at(-3.1, 1.4, middle));
  return problem;
}

TEST(HeldParts, ADoorTooNarrowForThePartIsNoWay) {
  PartSupplyProblem problem = chamber(false);
  const PartSupplyPlan none = plan_part_supply(problem, database());
  EXPECT_EQ(none.outcome, Outcome::not_found);
  ASSERT_EQ(none.obstructions.size(), 1u);
  EXPECT_EQ(none.obstructions[0].stage, "route");
  EXPECT_EQ(none.obstructions[0].part, "A/block_0");
  EXPECT_NE(none.obstructions[0].message.find("with part 'A/block_0' in the hand was found"), std::string::npos)
      << none.obstructions[0].message;

  problem.unload_region.reset();  // in the bin it passes, and the checker sees that it would not in the hand
  problem.place_region.drop_height = 0.15;
  const PartSupplyPlan binned = plan_part_supply(problem, database());
  expect_good(problem, binned);
}

TEST(HeldParts, AWiderWayIsTakenWithThePartInTheHand) {
  const PartSupplyProblem problem = chamber(true);
  const PartSupplyPlan plan = plan_part_supply(problem, database());
  expect_good(problem, plan);
  double highest = 0;
  for (const Eigen::Vector3d& pose : plan.route.back().poses) highest = std::max(highest, pose.y());
  EXPECT_GT(highest, 1.2) << "around the chamber, through its open side";

  verify::PlanToCheck straight = plan_to_check(problem, plan);
  const Eigen::Vector3d stop = plan.stops.back().pose;
  CollisionChecker empty(problem.arm, problem.world);
  const BasePath through_the_door = plan_base_route(empty, problem.home, stop, problem.goal, {});
  ASSERT_EQ(through_the_door.outcome, Outcome::solved);
  straight.route.back() = through_the_door.poses;
  straight.leg_values.clear();
  std::set<std::string> codes;
  for (const verify::Fault& fault : verify::check_plan(straight).faults) codes.insert(fault.code);
  EXPECT_EQ(codes, std::set<std::string>{"route-collision"}) << "a drive that is free with an empty hand alone";
}

TEST(HeldParts, ProblemsThatMakeNoSenseAreRefused) {
  PartSupplyProblem problem = storeroom_without_bin();
  problem.unload_region->size.x() = -1;
  EXPECT_THROW(problem.check(), InvalidInput);
  problem = storeroom_without_bin();
  problem.unload_region->drop_height = -0.1;
  EXPECT_THROW(problem.check(), InvalidInput);
  problem = storeroom_without_bin();
  problem.unload_region->T_world_region.rotate(Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitX()));
  EXPECT_THROW(problem.check(), InvalidInput);
  problem = storeroom_without_bin();
  problem.place_region.capacity = 2;
  EXPECT_THROW(problem.check(), InvalidInput);
}

}  // namespace
}  // namespace mmgrasp
