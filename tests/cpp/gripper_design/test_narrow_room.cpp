// Grippers for a part between walls: how far fingers open there, how wide the palm is, and how thick fingers may be.
#include <gtest/gtest.h>

#include <algorithm>

#include "gripper_design/simple_parts.hpp"
#include "mmgrasp/gripper_design/plan_grippers.hpp"

namespace mmgrasp {
namespace {

using test::at;
using test::block;

/// A key of 30 x 12 x 20 mm with walls of a height about it, so far off all its sides.
AssemblyOperation key_between_walls(double gap, double height) {
  AssemblyOperation o;
  o.name = "key";
  o.active = {{"key", block({0.015, 0.006, 0.01}), at(0, 0, 0.01)}};
  o.passive = {{"plate", block({0.1, 0.1, 0.005}), at(0, 0, -0.005)}};
  for (const double side : {1.0, -1.0}) {
    const std::string which = side > 0 ? "one" : "other";
    o.passive.push_back(
        {which + " along", block({0.03, 0.005, height / 2}), at(0, side * (0.006 + gap + 0.005), height / 2)});
    o.passive.push_back(
        {which + " across", block({0.005, 0.01, height / 2}), at(side * (0.015 + gap + 0.005), 0, height / 2)});
  }
  o.motion = {at(0, 0, 0.05), at(0, 0, 0)};
  return o;
}

TEST(PlanGrippers, OneMoreDriveCostsNoSolution) {
  // Walls 9.5 mm off, fingers 8 mm thick: those of a short stroke open by 1 mm, those of a long one by 2 mm.
  const AssemblyOperation o = key_between_walls(0.0095, 0.03);
  const GripperActuator shorter{"short", 2, 0.003}, longer{"long", 2, 0.03};
  EXPECT_EQ(plan_grippers({o}, {longer}).outcome, Outcome::not_found);
  for (const auto& drives : {std::vector{shorter}, std::vector{longer, shorter}, std::vector{shorter, longer}}) {
    const PlanGrippersResult found = plan_grippers({o}, drives);
    ASSERT_EQ(found.outcome, Outcome::solved) << drives.size();
    EXPECT_EQ(found.set->grippers[0].actuator, "short");
    const int taken = found.set->requirement_of_part[0];
    EXPECT_NEAR(found.grasps[taken].clearance, 0.001, 1e-12);
    EXPECT_EQ(found.requirements[taken].max_stroke, 0.003);
  }
}

TEST(PlanGrippers, PalmsAreAsWideAsTheStrokeAsks) {
  // Walls 25 mm high and 24 mm off let the palm of a short drive in between them, and not that of a long one.
  const AssemblyOperation o = key_between_walls(0.024, 0.025);
  const GripperActuator shorter{"short", 2, 0.006}, longer{"long", 2, 0.2};
  const PlanGrippersResult alone = plan_grippers({o}, {shorter}), wide = plan_grippers({o}, {longer}),
                           both = plan_grippers({o}, {longer, shorter});
  ASSERT_EQ(both.outcome, Outcome::solved);
  EXPECT_GT(wide.set->grippers[0].finger_length, alone.set->grippers[0].finger_length + 0.001);
  for (const SegmentRequirement& asked : alone.requirements) {
    const auto is_same = [&](const SegmentRequirement& r) {
      return r.opening == asked.opening && r.min_finger_length == asked.min_finger_length &&
             r.max_finger_length == asked.max_finger_length && r.max_stroke >= shorter.stroke;
    };
    EXPECT_TRUE(std::any_of(both.requirements.begin(), both.requirements.end(), is_same)) << asked.min_finger_length;
  }
}

TEST(PlanGrippers, SlimmerFingersAreAdvisedWhereAGapIsTooNarrow) {
  // Fingers open by 2 mm to let go: 3.5 mm of 5.5 mm are left.
  const AssemblyOperation o = key_between_walls(0.0055, 0.03);
  const std::vector<GripperActuator> jaws{{"jaws", 2, 0.03}};
  PlanGrippersOptions options;
  const std::vector<std::string> help = plan_grippers({o}, jaws, {}, options).help;
  EXPECT_EQ(std::count(help.begin(), help.end(), "key: fingers 3.5 mm thick would do"), 1);
  options.finger_thickness = 0.0035;
  EXPECT_EQ(plan_grippers({o}, jaws, {}, options).outcome, Outcome::solved);
  options.finger_thickness = 0.0036;
  EXPECT_NE(plan_grippers({o}, jaws, {}, options).outcome, Outcome::solved);
}

}  // namespace
}  // namespace mmgrasp
