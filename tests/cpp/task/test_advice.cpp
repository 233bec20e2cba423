#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "mmgrasp/core/random.hpp"
#include "mmgrasp/task/base_pose_evaluator.hpp"
#include "mmgrasp/task/part_supply.hpp"
#include "support/small_storeroom.hpp"

namespace mmgrasp {
namespace {

const ReachDatabase& database() {
  static const ReachDatabase shared = test::small_database(test::small_storeroom());
  return shared;
}

/// As a scenario's reader does: candidates for each block, those wider than the gripper opens counted and dropped.
void give_grasps(PartSupplyProblem& problem) {
  for (Tray& tray : problem.trays) {
    for (Part& part : tray.parts) {
      const double width = std::get<Box>(part.shapes[0].shape).size.x();
      const std::vector<Grasp> grasps = test::grasps_from_above(width);
      const bool fits = width <= problem.gripper.max_opening;
      part.grasps = fits ? grasps : std::vector<Grasp>();
      part.grasps_too_wide = fits ? 0 : static_cast<int>(grasps.size());
    }
  }
}

void set_opening(PartSupplyProblem& problem, double opening) {
  problem.gripper.max_opening = opening;
  for (HandJoint& joint : problem.gripper.joints) joint.open = 0.5 * opening;
  give_grasps(problem);
}

PartSupplyProblem coarse_storeroom() {
  PartSupplyProblem problem = test::small_storeroom(1);
  problem.options.grid.resolution = 0.08;
  problem.options.robustness_samples = 40;
  problem.world.add("floor", test::box_shape(8, 8, 0.10), test::at(0, 0, -0.05));
  return problem;
}

enum class Kind { uncertainty, step, crates, shelf, wide };

/// Failures of different kinds with random sizes and places.
Kind kind_of(int number) {
  constexpr Kind kinds[] = {Kind::uncertainty, Kind::step, Kind::crates, Kind::shelf, Kind::wide};
  return kinds[number % 5];
}

PartSupplyProblem seeded_failure(int number) {
  PartSupplyProblem problem = coarse_storeroom();
  Rng rng(2026, static_cast<std::uint64_t>(number));
  switch (kind_of(number)) {
    case Kind::uncertainty: {
      problem.options.positioning_uncertainty *= rng.uniform(8, 15);
      break;
    }
    case Kind::step: {  // one low step under the table and far in front of it: the arm reaches over, the base cannot
                        // come near
      if (number % 2) problem.trays.pop_back();
      const double depth = rng.uniform(1.8, 2.1);
      problem.world.add("step", test::box_shape(depth, 4.0, 0.10),
                        test::at(-0.25 + 0.5 * depth, rng.uniform(-0.2, 0.2), 0.05));
      break;
    }
    case Kind::crates: {  // the tray stands off to the side where low crates cover the floor
      problem.trays.pop_back();
      const double x = rng.uniform(-0.05, 0.05), y = rng.uniform(0.9, 1.3);
      problem.world.move("table", test::at(0.9 + x, y, 0.42));
      for (Pose* T : {&problem.trays[0].T_world_tray, &problem.trays[0].parts[0].T_world_part})
        T->translation() += Eigen::Vector3d(x, y, 0);
      for (int i = 0; i < 32; ++i) {  // with gaps too narrow for the base
        problem.world.add("crate_" + std::to_string(i), test::box_shape(rng.uniform(0.30, 0.50), 0.28, 0.12),
                          test::at(0.15 + 0.5 * (i % 4), y - 1.2 + 0.3 * (i / 4), 0.06));
      }
      break;
    }
    case Kind::shelf: {  // a board over the tray keeps hand and arm out
      problem.trays.pop_back();
      problem.world.add("shelf", test::box_shape(0.34, rng.uniform(0.6, 0.9), 0.03),
                        test::at(0.86, -0.15, rng.uniform(0.58, 0.62)));
      break;
    }
    case Kind::wide: {
      const double width = rng.uniform(0.045, 0.058);
      problem.trays[1].parts[0].shapes[0].shape = test::box_shape(width, width, 0.06);
      set_opening(problem, 0.04);
      break;
    }
  }
  return problem;
}

/// Does what the obstructions say, and nothing else.
PartSupplyProblem with_advice_applied(PartSupplyProblem problem, const std::vector<Obstruction>& obstructions) {
  std::set<std::string> moved;
  for (const Obstruction& reported : obstructions) {
    if (reported.needed_opening > 0) set_opening(problem, reported.needed_opening);
    if (reported.largest_uncertainty > 0) {
      problem.options.positioning_uncertainty =
          std::min(problem.options.positioning_uncertainty, reported.largest_uncertainty);
    }
    if (reported.move_trays.empty() || moved.count(reported.tray)) continue;
    const Eigen::Vector3d by(reported.advised_move.x(), reported.advised_move.y(), 0);
    for (const std::string& name : reported.move_objects) {
      Pose T = problem.world.objects().at(name).T_world_object;
      T.translation() += by;
      problem.world.move(name, T);
    }
    for (Tray& tray : problem.trays) {
      if (std::count(reported.move_trays.begin(), reported.move_trays.end(), tray.name) == 0) continue;
      moved.insert(tray.name);
      tray.T_world_tray.translation() += by;
      for (Part& part : tray.parts) part.T_world_part.translation() += by;
    }
  }
  return problem;
}

std::string all_messages(const PartSupplyPlan& plan) {
  std::string text;
  for (const Obstruction& some : plan.obstructions) text += some.stage + ": " + some.message + "\n";
  return text;
}

void expect_advice_of_its_kind(Kind kind, const Obstruction& reported) {
  if (kind == Kind::uncertainty) {
    EXPECT_EQ(reported.stage, "robustness");
    EXPECT_GT(reported.largest_uncertainty, 0);
  } else if (kind == Kind::wide) {
    EXPECT_EQ(reported.stage, "grasp");
    EXPECT_EQ(reported.tray, "B");
    EXPECT_GT(reported.needed_opening, 0.04);
  } else {
    EXPECT_GT(reported.advised_move.norm(), 0) << reported.message;
    ASSERT_FALSE(reported.move_trays.empty()) << reported.message;
    EXPECT_EQ(reported.move_trays[0], reported.tray);
    EXPECT_EQ(reported.move_objects, std::vector<std::string>{"table"});
  }
}

TEST(Advice, AppliedItSolvesNineOfTenSeededFailures) {
  int solved = 0;
  std::string left;
  for (int number = 0; number < 10; ++number) {
    SCOPED_TRACE("failure " + std::to_string(number));
    const PartSupplyProblem problem = seeded_failure(number);
    const PartSupplyPlan failed = plan_part_supply(problem, database());
    // Proven where a part is too wide for every grasp.
    const bool proven = kind_of(number) == Kind::wide;
    ASSERT_EQ(failed.outcome, proven ? Outcome::infeasible : Outcome::not_found);
    ASSERT_FALSE(failed.obstructions.empty());
    for (const Obstruction& reported : failed.obstructions) {
      EXPECT_FALSE(reported.tray.empty());
      EXPECT_FALSE(reported.part.empty());
      expect_advice_of_its_kind(kind_of(number), reported);
    }
    const PartSupplyPlan fixed = plan_part_supply(with_advice_applied(problem, failed.obstructions), database());
    solved += fixed.outcome == Outcome::solved;
    if (fixed.outcome != Outcome::solved) {
      left += "failure " + std::to_string(number) + "\n" + all_messages(failed) +
              "after the fix: " + to_string(fixed.outcome) + "\n" + all_messages(fixed);
    }
  }
  EXPECT_GE(solved, 9) << left;
  RecordProperty("solved", solved);
}

/// Half of the advised move is not enough: the advice is no longer than it has to be by more than the cell of margin.
TEST(Advice, HalfTheMoveIsNotEnough) {
  const PartSupplyProblem problem = seeded_failure(1);
  PartSupplyPlan failed = plan_part_supply(problem, database());
  ASSERT_FALSE(failed.obstructions.empty());
  for (Obstruction& reported : failed.obstructions) {
    ASSERT_GT(reported.advised_move.norm(), 2 * problem.options.grid.resolution);
    EXPECT_GE(reported.advised_move.norm(), reported.reach_deficit - problem.options.grid.resolution);
    reported.advised_move *= 0.5;
  }
  EXPECT_EQ(plan_part_supply(with_advice_applied(problem, failed.obstructions), database()).outcome,
            Outcome::not_found);
}

/// The failed plan's counters again from single base poses: no rows, no threads, no grasp tried first.
TEST(Advice, CountersOfAFailedPlanAreWhatTheEvaluatorRecounts) {
  const PartSupplyProblem problem = seeded_failure(1);
  const PartSupplyPlan failed = plan_part_supply(problem, database());
  ASSERT_EQ(failed.regions.size(), 1u);
  const BaseGrid& grid = failed.grid;
  BasePoseEvaluator evaluator(problem, database());
  const Tray& tray = problem.trays[0];
  const double radius = database().reach() + 0.5 * tray.size.head<2>().norm();
  PartExplanation recount;
  std::size_t in_collision = 0;
  const auto look = [&](const Eigen::Vector3d& pose) {
    if (evaluator.home(pose) != Rejection::none) return false;
    ++recount.base_poses_tried;
    const PartAtPose seen = evaluator.part(pose, {TrayId(0), 0});
    for (Rejection cause : seen.causes) recount.rejections.add(cause);
    recount.base_poses_feasible += seen.feasible;
    return seen.feasible;
  };
  std::set<std::pair<int, int>> corners;
  for (int iy = 0; iy < grid.ny; ++iy) {
    for (int ix = 0; ix < grid.nx; ++ix) {
      const Eigen::Vector3d pose = grid.centre(0, ix, iy);
      if ((pose.head<2>() - tray.T_world_tray.translation().head<2>()).norm() > radius) continue;
      in_collision += evaluator.home(pose) != Rejection::none;
      if (!look(pose)) continue;
      for (int c = 0; c < 4; ++c) corners.insert({ix + c % 2, iy + c / 2});
    }
  }
  for (const auto& [ix, iy] : corners) {
    Eigen::Vector3d pose = grid.centre(0, ix, iy);
    pose.head<2>().array() -= 0.5 * grid.resolution;
    look(pose);
  }
  const PartExplanation& reported = failed.regions[0].explanations[0];
  EXPECT_GT(reported.base_poses_tried, 0u);
  EXPECT_GT(failed.regions[0].base_poses_in_collision, 0u);
  EXPECT_EQ(reported.base_poses_tried, recount.base_poses_tried);
  EXPECT_EQ(reported.base_poses_feasible, recount.base_poses_feasible);
  EXPECT_EQ(reported.rejections, recount.rejections)
      << reported.rejections.summary() << " against " << recount.rejections.summary();
  EXPECT_EQ(failed.regions[0].base_poses_in_collision, in_collision);
}

}  // namespace
}  // namespace mmgrasp
