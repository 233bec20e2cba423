#include "mmgrasp/task/part_supply.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/task/plan_to_check.hpp"
#include "mmgrasp/verify/plan_check.hpp"
#include "support/small_storeroom.hpp"

namespace mmgrasp {
namespace {

const ReachDatabase& database() {
  static const ReachDatabase shared = test::small_database(test::small_storeroom());
  return shared;
}

std::string all_messages(const PartSupplyPlan& plan) {
  std::string text;
  for (const Obstruction& some : plan.obstructions) text += some.stage + ": " + some.message + "\n";
  return text;
}

TEST(PartSupply, SmallStoreroomIsSolvedAndHoldsForTheIndependentChecker) {
  const PartSupplyProblem problem = test::small_storeroom();
  const PartSupplyPlan plan = plan_part_supply(problem, database());
  ASSERT_EQ(plan.outcome, Outcome::solved) << all_messages(plan);
  EXPECT_TRUE(plan.obstructions.empty());
  EXPECT_EQ(plan.stops.size(), 1u);
  EXPECT_EQ(plan.lower_bound, 1);
  EXPECT_TRUE(plan.proven_minimal);
  EXPECT_EQ(plan.route.size(), 2u);
  ASSERT_EQ(plan.picks.size(), 4u);
  EXPECT_GE(plan.robustness_rate, 0.999);
  verify::PlanCheckOptions options;
  options.samples = 100;
  const verify::PlanCheckResult result = verify::check_plan(plan_to_check(problem, plan), options);
  for (const verify::Fault& fault : result.faults)
    ADD_FAILURE() << fault.code << ", " << fault.where << ": " << fault.message;
  EXPECT_EQ(result.minimal_stops, 1);
}

/// With a covariance, stops say how many arrivals they serve, and the independent checker counts the same share.
TEST(PartSupply, StopsSayHowSureTheyAre) {
  PartSupplyProblem problem = test::small_storeroom();
  problem.options.grid.resolution = 0.08;
  problem.options.positioning_uncertainty = 0.02;
  const PartSupplyPlan without = plan_part_supply(problem, database());
  problem.arrival_covariance = Eigen::Vector3d(0.05, 0.03, 0.2).asDiagonal();
  problem.options.robustness_samples = 1000;
  const PartSupplyPlan plan = plan_part_supply(problem, database());
  ASSERT_EQ(plan.outcome, Outcome::solved) << all_messages(plan);
  EXPECT_EQ(plan.stops.size(), without.stops.size());
  for (const Stop& stop : without.stops) EXPECT_EQ(stop.arrivals, 0u);
  for (const Stop& stop : plan.stops) {
    EXPECT_EQ(stop.arrivals, 1000u);
    EXPECT_GT(stop.arrivals_served, 50u);
    EXPECT_LT(stop.arrivals_served, 990u);
    EXPECT_GE(stop.radius, problem.options.positioning_uncertainty);
  }
  verify::PlanToCheck check = plan_to_check(problem, plan);
  for (const verify::Fault& fault : verify::check_plan(check).faults)
    ADD_FAILURE() << fault.code << ", " << fault.where << ": " << fault.message;
  int& served = check.stops[0].arrivals_served;
  served += served > 500 ? -200 : 200;
  const verify::PlanCheckResult spoiled = verify::check_plan(check);
  ASSERT_EQ(spoiled.faults.size(), 1u);
  EXPECT_EQ(spoiled.faults[0].code, "arrival-rate");
}

/// `twist` has no limits: its numbers run on from motion to motion and from pick to pick. Home is reached up to its
/// turns.
TEST(PartSupply, MotionsJoinAsPlainNumbersOverTheWholePlan) {
  PartSupplyProblem problem = test::small_storeroom();
  problem.options.robustness_samples = 40;
  for (double home : {0.0, 3.0}) {
    problem.home[5] = home;
    const PartSupplyPlan plan = plan_part_supply(problem, database());
    ASSERT_EQ(plan.outcome, Outcome::solved) << all_messages(plan);
    ASSERT_EQ(plan.picks.size(), 4u);
    Eigen::VectorXd at = problem.home;
    for (const Pick& pick : plan.picks) {
      ASSERT_EQ(pick.motions.size(), 5u);
      for (const PickMotion& motion : pick.motions) {
        EXPECT_LE((motion.trajectory.positions.front() - at).cwiseAbs().maxCoeff(), 1e-9) << to_string(motion.kind);
        for (std::size_t i = 1; i < motion.trajectory.positions.size(); ++i) {
          const double moved =
              (motion.trajectory.positions[i] - motion.trajectory.positions[i - 1]).cwiseAbs().maxCoeff();
          EXPECT_LE(moved, 1.5 * (motion.trajectory.times[i] - motion.trajectory.times[i - 1]) + 1e-6);
        }
        at = motion.trajectory.positions.back();
      }
      EXPECT_LE((at - problem.home).head(5).cwiseAbs().maxCoeff(), 1e-9);
      const double turns = (at[5] - home) / (2 * M_PI);
      EXPECT_NEAR(turns, std::round(turns), 1e-9);
    }
  }
}

TEST(PartSupply, TheSamePlanAtAnyThreadCount) {
  PartSupplyProblem problem = test::small_storeroom(1);
  problem.options.grid.resolution = 0.08;
  problem.options.robustness_samples = 40;
  std::vector<PartSupplyPlan> plans;
  for (int threads : {1, 3}) {
    problem.options.threads = threads;
    plans.push_back(plan_part_supply(problem, database()));
  }
  ASSERT_EQ(plans[0].outcome, Outcome::solved) << all_messages(plans[0]);
  ASSERT_EQ(plans[1].outcome, Outcome::solved);
  ASSERT_EQ(plans[0].picks.size(), plans[1].picks.size());
  for (std::size_t i = 0; i < plans[0].picks.size(); ++i) {
    EXPECT_EQ(plans[0].picks[i].grasp, plans[1].picks[i].grasp);
    for (std::size_t m = 0; m < plans[0].picks[i].motions.size(); ++m) {
      EXPECT_EQ(plans[0].picks[i].motions[m].trajectory.positions, plans[1].picks[i].motions[m].trajectory.positions);
    }
  }
  for (std::size_t leg = 0; leg < plans[0].route.size(); ++leg)
    EXPECT_EQ(plans[0].route[leg].poses, plans[1].route[leg].poses);
}

/// The advised uncertainty works, a little more does not.
TEST(PartSupply, TooLargeAnUncertaintyAdvisesOneThatWorks) {
  PartSupplyProblem problem = test::small_storeroom(1);
  problem.options.robustness_samples = 40;
  problem.options.positioning_uncertainty = 0.5;
  const PartSupplyPlan failed = plan_part_supply(problem, database());
  ASSERT_EQ(failed.outcome, Outcome::not_found);
  EXPECT_FALSE(failed.proven_minimal);
  ASSERT_FALSE(failed.obstructions.empty());
  double advised = 1;
  for (const Obstruction& some : failed.obstructions) {
    EXPECT_EQ(some.stage, "robustness");
    EXPECT_FALSE(some.part.empty());
    advised = std::min(advised, some.largest_uncertainty);
  }
  ASSERT_GT(advised, 0.01);
  problem.options.positioning_uncertainty = advised;
  const PartSupplyPlan fixed = plan_part_supply(problem, database());
  EXPECT_EQ(fixed.outcome, Outcome::solved) << all_messages(fixed);
  problem.options.positioning_uncertainty = advised + 1e-4;
  EXPECT_EQ(plan_part_supply(problem, database()).outcome, Outcome::not_found);
}

TEST(PartSupply, APartWithoutGraspsIsNamed) {
  PartSupplyProblem problem = test::small_storeroom(1);
  problem.options.grid.resolution = 0.1;
  problem.trays[1].parts[0].grasps.clear();
  problem.trays[1].parts[0].grasps_too_wide = 7;
  const PartSupplyPlan plan = plan_part_supply(problem, database());
  EXPECT_EQ(plan.outcome, Outcome::infeasible);
  ASSERT_EQ(plan.obstructions.size(), 1u);
  EXPECT_EQ(plan.obstructions[0].tray, "B");
  EXPECT_EQ(plan.obstructions[0].part, "B/block_0");
  EXPECT_EQ(plan.obstructions[0].stage, "grasp");
  EXPECT_NE(plan.obstructions[0].message.find("7"), std::string::npos);
  EXPECT_LT(plan.obstructions[0].largest_uncertainty, 0);
}

/// A low step keeps the base away; bringing tray and table nearer by the missing reach (and room for the disc) helps.
TEST(PartSupply, MissingReachSaysHowFarToMove) {
  PartSupplyProblem problem = test::small_storeroom(1);
  problem.options.robustness_samples = 40;
  problem.trays.pop_back();
  problem.world.add("step", test::box_shape(2.0, 4.0, 0.10), test::at(0.75, 0, 0.05));
  const PartSupplyPlan failed = plan_part_supply(problem, database());
  ASSERT_EQ(failed.outcome, Outcome::not_found);
  ASSERT_EQ(failed.obstructions.size(), 1u);
  const Obstruction& reported = failed.obstructions[0];
  EXPECT_EQ(reported.stage, "region");
  ASSERT_GT(reported.reach_deficit, 0.0);
  const double nearer = reported.reach_deficit + 0.45;
  Tray& tray = problem.trays[0];
  tray.T_world_tray.translation().x() -= nearer;
  tray.parts[0].T_world_part.translation().x() -= nearer;
  problem.world.move("table", test::at(0.9 - nearer, 0, 0.42));
  const PartSupplyPlan fixed = plan_part_supply(problem, database());
  EXPECT_EQ(fixed.outcome, Outcome::solved) << all_messages(fixed);
}

/// A part that other parts cover may be freed, one under a lid not.
TEST(PartSupply, OnlyWhatNoBasePoseAndNoArmReachesIsProven) {
  PartSupplyProblem problem = test::small_storeroom(1);
  problem.options.grid.resolution = 0.1;
  Part& part = problem.trays[0].parts[0];
  const Eigen::Vector3d on_table = part.T_world_part.translation();
  const JointGroup stretched = problem.arm;
  double highest = 0;
  Rng rng(3);
  for (int i = 0; i < 200000; ++i) {
    Eigen::VectorXd q = stretched.sample_lower();
    for (int k = 0; k < q.size(); ++k) q[k] = rng.uniform(q[k], stretched.sample_upper()[k]);
    highest = std::max(highest, stretched.fk(q).translation().z());
  }
  part.T_world_part.translation().z() = highest - 0.01;  // the tool gets there, though not with the hand pointing down
  EXPECT_EQ(plan_part_supply(problem, database()).outcome, Outcome::not_found);
  part.T_world_part.translation().z() = highest + 0.5;
  EXPECT_EQ(plan_part_supply(problem, database()).outcome, Outcome::infeasible);
  part.T_world_part.translation() = on_table;
  problem.world.add("lid", test::box_shape(0.2, 0.2, 0.01),
                    Pose(Eigen::Translation3d(on_table.x(), on_table.y(), 0.51)));
  EXPECT_EQ(plan_part_supply(problem, database()).outcome, Outcome::infeasible);
  part.grasps_sampled = true;  // of others nothing is known
  EXPECT_EQ(plan_part_supply(problem, database()).outcome, Outcome::not_found);
  part.T_world_part.translation().z() = highest + 0.5;  // but nobody has longer links
  EXPECT_EQ(plan_part_supply(problem, database()).outcome, Outcome::infeasible);
  part.T_world_part.translation() = on_table;
  part.grasps_sampled = false;
  problem.world.remove("lid");
  Part lid = problem.trays[1].parts[0];
  lid.name = "B/lid";
  lid.target = false;
  lid.shapes[0].shape = test::box_shape(0.2, 0.2, 0.01);
  lid.T_world_part = Pose(Eigen::Translation3d(on_table.x(), on_table.y(), 0.51));
  problem.trays[1].parts.push_back(lid);
  EXPECT_EQ(plan_part_supply(problem, database()).outcome, Outcome::not_found);
}

/// Under the roof every part can be grasped in front of the table, but not lifted; on its other side it can.
TEST(PartSupply, WhereNoMotionIsFoundOtherStopsAreTried) {
  PartSupplyProblem problem = test::small_storeroom();
  problem.world.add("roof", test::box_shape(0.5, 2.5, 0.01), test::at(0.55, 0, 0.85));
  const PartSupplyPlan plan = plan_part_supply(problem, database());
  ASSERT_EQ(plan.outcome, Outcome::solved) << all_messages(plan);
  ASSERT_EQ(plan.stops.size(), 1u);
  EXPECT_GT(plan.stops[0].pose.x(), 1.0);
  EXPECT_TRUE(plan.proven_minimal);
  const BaseRegion& region = plan.regions[0];
  std::size_t in_front = 0;
  for (int iy = 0; iy < plan.grid.ny; ++iy) {
    for (int ix = 0; ix < plan.grid.nx; ++ix)
      in_front += region.cells[plan.grid.index(0, ix, iy)] && plan.grid.centre(0, ix, iy).x() < 0.6;
  }
  EXPECT_GT(in_front, 50u);  // they stay in the region: what is proven is proven with them
  verify::PlanCheckOptions options;
  options.samples = 100;
  for (const verify::Fault& fault : verify::check_plan(plan_to_check(problem, plan), options).faults)
    ADD_FAILURE() << fault.code << ", " << fault.where << ": " << fault.message;
}

TEST(PartSupply, AStartInCollisionIsRefusedByName) {
  PartSupplyProblem problem = test::small_storeroom(1);
  problem.start = Eigen::Vector3d(0.9, 0, 0);
  try {
    plan_part_supply(problem, database());
    FAIL() << "was accepted";
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("start"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("table"), std::string::npos);
  }
}

TEST(PartSupply, AGridTooFineIsRefusedByName) {
  PartSupplyProblem problem = test::small_storeroom(1);
  problem.options.grid.resolution = 1e-6;
  try {
    make_base_grid(problem, database());
    FAIL() << "accepted";
  } catch (const InvalidInput& error) {
    EXPECT_NE(std::string(error.what()).find("grid.resolution = 1e-06"), std::string::npos) << error.what();
  }
}

TEST(PartSupply, BadOptionsAreRefusedByName) {
  const auto message = [](auto change) {
    PartSupplyProblem problem = test::small_storeroom(1);
    change(problem);
    try {
      problem.check();
    } catch (const InvalidInput& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(message([](auto& p) { p.options.grid.resolution = 0; }).find("grid.resolution"), std::string::npos);
  EXPECT_NE(message([](auto& p) { p.options.positioning_uncertainty = -0.1; }).find("positioning_uncertainty"),
            std::string::npos);
  EXPECT_NE(message([](auto& p) { p.home[2] = 9; }).find("elbow"), std::string::npos);
  EXPECT_NE(message([](auto& p) { p.trays[1].name = "A"; }).find("tray name"), std::string::npos);
  EXPECT_NE(message([](auto& p) { p.trays[1].parts[0].name = "table"; }).find("table"), std::string::npos);
  EXPECT_NE(message([](auto& p) { p.trays[0].parts[0].grasps[0].opening = 0.2; }).find("max_opening"),
            std::string::npos);
  EXPECT_EQ(message([](auto&) {}), "");
}

TEST(PartSupply, AStoppedMonitorEndsThePlan) {
  const PartSupplyProblem problem = test::small_storeroom(1);
  Monitor monitor;
  monitor.stop.stop();
  EXPECT_EQ(plan_part_supply(problem, database(), monitor).outcome, Outcome::stopped);
}

}  // namespace
}  // namespace mmgrasp
