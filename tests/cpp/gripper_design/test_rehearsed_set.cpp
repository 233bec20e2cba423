// A set of grippers is chosen again without the grasps that a rehearsal refused, until every operation goes through.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <string>
#include <vector>

#include "gripper_design/simple_parts.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/gripper_design/plan_grippers.hpp"

namespace mmgrasp {
namespace {

using test::at;
using test::block;

constexpr double kThickness = 0.008;  // The default of fingers [m].
constexpr double kHair = 5e-6;        // Fingers pass walls by this, but not once they are rehearsed, 0.02 mm off [m].

const std::vector<GripperActuator> kJaws{{"jaws", 2, 0.03}};

/// A key of 30 x 12 x 20 mm is put between two walls that leave room for a finger's thickness and a gap at either of
/// its long sides, on which pads have most surface.
AssemblyOperation key_between_walls(const std::string& name, double gap) {
  AssemblyOperation o;
  const double wall = 0.006 + kThickness + gap + 0.005;
  o.name = name;
  o.active = {{name, block({0.015, 0.006, 0.01}), at(0, 0, 0.01)}};
  o.passive = {{"plate", block({0.1, 0.1, 0.005}), at(0, 0, -0.005)},
               {"left wall", block({0.008, 0.005, 0.015}), at(0, -wall, 0.015)},
               {"right wall", block({0.008, 0.005, 0.015}), at(0, wall, 0.015)}};
  o.motion = {at(0, 0, 0.05), at(0, 0, 0)};
  return o;
}

PlanGrippersOptions without_clearance() {
  PlanGrippersOptions options;
  options.clearance = 0;  // Else fingers would meet the walls where they let go, and no such grasp were free.
  return options;
}

double opening_taken(const PlanGrippersResult& found, int operation = 0) {
  return found.requirements[found.set->requirement_of_part[operation]].opening;
}

TEST(RehearsedSet, TheNextBestGraspIsTakenWhereTheFirstIsRefused) {
  const PlanGrippersResult wide = plan_grippers({key_between_walls("key", 1e-4)}, kJaws, {}, without_clearance());
  ASSERT_EQ(wide.outcome, Outcome::solved);
  EXPECT_NEAR(opening_taken(wide), 0.012, 1e-6);
  EXPECT_EQ(wide.rehearsals, 1);
  EXPECT_TRUE(wide.left_out.empty());

  PlanGrippersOptions options = without_clearance();
  options.threads = 1;
  const PlanGrippersResult found = plan_grippers({key_between_walls("key", kHair)}, kJaws, {}, options);
  ASSERT_EQ(found.outcome, Outcome::solved);
  EXPECT_NEAR(opening_taken(found), 0.03, 1e-6);
  EXPECT_EQ(found.met, std::vector<std::string>{""});
  ASSERT_FALSE(found.left_out.empty());
  EXPECT_EQ(found.rehearsals, static_cast<int>(found.left_out.size()) + 1);
  EXPECT_EQ(found.set->lower_bound, 1);
  for (const RefusedGrasp& r : found.left_out) {
    EXPECT_NEAR(found.requirements[r.requirement].opening, 0.012, 1e-6);
    EXPECT_EQ(r.met, "finger_1 meets left wall during the motion");
  }
  options.threads = 3;
  const PlanGrippersResult again = plan_grippers({key_between_walls("key", kHair)}, kJaws, {}, options);
  EXPECT_EQ(again.set->requirement_of_part, found.set->requirement_of_part);
  EXPECT_EQ(again.rehearsals, found.rehearsals);
}

TEST(RehearsedSet, OperationsKeepTheirOrderAndOneRefusalCostsTheOthersNothing) {
  std::vector<AssemblyOperation> order{key_between_walls("a", kHair), key_between_walls("b", 1e-4)};
  const PlanGrippersResult found = plan_grippers(order, kJaws, {}, without_clearance());
  ASSERT_EQ(found.outcome, Outcome::solved);
  EXPECT_EQ(found.set->parts, (std::vector<std::string>{"a", "b"}));
  EXPECT_NEAR(opening_taken(found, 0), 0.03, 1e-6);
  EXPECT_NEAR(opening_taken(found, 1), 0.012, 1e-6);
  EXPECT_EQ(found.set->grippers.size(), 1u);
}

TEST(RehearsedSet, NothingIsFoundWhereEveryGraspIsRefused) {
  const KeepOff ends{"key", {}, {{at(0.015, 0, 0), {0.002, 0.1, 0.1}}, {at(-0.015, 0, 0), {0.002, 0.1, 0.1}}}};
  const PlanGrippersResult found = plan_grippers({key_between_walls("key", kHair)}, kJaws, {ends}, without_clearance());
  EXPECT_EQ(found.outcome, Outcome::not_found);
  ASSERT_TRUE(found.set);
  EXPECT_EQ(found.met, std::vector<std::string>{"finger_1 meets left wall during the motion"});
  EXPECT_EQ(found.left_out.size(), found.requirements.size());
  ASSERT_EQ(found.missing.size(), 1u);
  EXPECT_EQ(found.missing[0].substr(0, 87),
            "key: its rehearsal refuses every grasp: finger_1 meets left wall during the motion (" +
                std::to_string(found.left_out.size()) + " t");
}

TEST(RehearsedSet, EndsAfterSoManyRehearsalsAndWhenItIsStopped) {
  PlanGrippersOptions options = without_clearance();
  options.max_rehearsals = 1;
  const std::vector<AssemblyOperation> order{key_between_walls("key", kHair)};
  const PlanGrippersResult once = plan_grippers(order, kJaws, {}, options);
  EXPECT_EQ(once.outcome, Outcome::not_found);
  EXPECT_EQ(once.rehearsals, 1);
  EXPECT_EQ(once.left_out.size(), 1u);
  EXPECT_EQ(once.met, std::vector<std::string>{"finger_1 meets left wall during the motion"});
  options.max_rehearsals = 0;
  EXPECT_THROW(plan_grippers(order, kJaws, {}, options), InvalidInput);

  Monitor monitor;
  std::set<std::string> stages;
  monitor.progress = [&](const std::string& stage, double) { stages.insert(stage); };
  EXPECT_EQ(plan_grippers(order, kJaws, {}, without_clearance(), monitor).outcome, Outcome::solved);
  EXPECT_EQ(stages.count("rehearsal, 1 grasp left out"), 1u);
  int chosen = 0;
  monitor.progress = [&](const std::string& stage, double) {
    if (stage == "least set of grippers" && ++chosen == 2) monitor.stop.stop();
  };
  const PlanGrippersResult stopped = plan_grippers(order, kJaws, {}, without_clearance(), monitor);
  EXPECT_EQ(stopped.outcome, Outcome::stopped);
  EXPECT_EQ(stopped.rehearsals, 1);
}

/// A bar of 40 x 12 x 2.8 mm between a floor and a lid: fingers of 4 mm come from either end. Beside its half at
/// `side` (1 or -1) stands a wall, a hair beyond the finger.
AssemblyOperation bar_under_lid(double side) {
  AssemblyOperation o;
  o.name = "bar";
  o.active = {{"bar", block({0.02, 0.006, 0.0014}), Pose::Identity()}};
  const double wall = 0.006 + kThickness + kHair + 0.005;
  for (const double z : {0.0114, -0.0114})
    o.passive.push_back({z > 0 ? "lid" : "floor", block({0.02, 0.1, 0.005}), at(0, 0, z)});
  o.passive.push_back({"wall", block({0.005, 0.005, 0.002}), at(side * 0.012, wall, 0)});
  o.motion = {Pose::Identity()};
  return o;
}

TEST(RehearsedSet, GraspsThatNoneChoseAgainstOthersAsGoodComeInWhereTheseAreRefused) {
  PlanGrippersOptions options = without_clearance();
  options.finger_width = 0.004;
  std::size_t refused = 0;
  for (const double side : {1.0, -1.0}) {
    const PlanGrippersResult found = plan_grippers({bar_under_lid(side)}, kJaws, {}, options);
    ASSERT_EQ(found.outcome, Outcome::solved) << side;
    const AssemblyGrasp& grasp = found.grasps[found.set->requirement_of_part[0]];
    EXPECT_NEAR(grasp.contact_length, 0.02, 1e-6) << side;  // as deep from this end as from the other one
    EXPECT_GT(side * grasp.T_active_tool.linear()(0, 2), 0.99) << side;
    refused += found.left_out.size();
  }
  EXPECT_GT(refused, 0u);
}

}  // namespace
}  // namespace mmgrasp
