// The whole job from structs: parts and an order in, grippers out, against what can be worked out by hand.
#include "mmgrasp/gripper_design/plan_grippers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "gripper_design/simple_parts.hpp"
#include "mmgrasp/core/detail/interruption.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/gripper_design/operation_load.hpp"
#include "mmgrasp/gripper_design/rehearse_operation.hpp"

namespace mmgrasp {
namespace {

using test::at;
using test::block;
using test::turned;

const std::vector<GripperActuator> kChuck{{"chuck", 3, 0.016}};

/// A peg on a foot stands out 20 mm over a ring of 20 mm in diameter and 12 mm in height that is put over it.
std::vector<AssemblyOperation> ring_on_peg() {
  AssemblyOperation o;
  o.name = "ring";
  o.active = {{"ring", turned({{0.005, 0}, {0.01, 0}, {0.01, 0.012}, {0.005, 0.012}}), at(0, 0, 0.008)}};
  o.passive = {{"plate", block({0.06, 0.06, 0.005}), at(0, 0, -0.005)},
               {"peg", turned({{0, 0}, {0.012, 0}, {0.012, 0.008}, {0.0049, 0.008}, {0.0049, 0.04}, {0, 0.04}})}};
  o.motion = {at(0, 0, 0.045), at(0, 0, 0)};
  return {o};
}

/// Planned once for the tests that look at it.
const PlanGrippersResult& ring_plan() {
  static const PlanGrippersResult plan = plan_grippers(ring_on_peg(), kChuck);
  return plan;
}

TEST(PlanGrippers, ARingOnAPegGetsOneGripperThatWasRehearsed) {
  const PlanGrippersResult& found = ring_plan();
  ASSERT_EQ(found.outcome, Outcome::solved);
  ASSERT_TRUE(found.set);
  ASSERT_EQ(found.set->grippers.size(), 1u);
  EXPECT_EQ(found.met, std::vector<std::string>{""});
  const int taken = found.set->requirement_of_part[0];
  EXPECT_NEAR(found.requirements[taken].opening, 0.02, 1e-4);
  const Gripper& gripper = found.set->grippers[0];
  EXPECT_EQ(gripper.fingers, 3);
  EXPECT_LE(gripper.min_opening + 0.001, 0.02);
  EXPECT_GE(gripper.max_opening - 0.001, 0.02);
  // Held as deep as the ring is high, less half a millimetre; the peg's top is 31.5 mm over the tips there.
  EXPECT_NEAR(found.grasps[taken].contact_length, 0.0115, 1e-4);
  EXPECT_NEAR(found.requirements[taken].min_finger_length, 0.0315, 1e-4);
  EXPECT_NEAR(gripper.finger_length, 0.0325, 1e-4);
}

TEST(PlanGrippers, OpenMeshesInsideOutAreHeldAsIfTheyWereNot) {
  // One triangle is missing in the ring's bore, and all look inwards, as exports of surfaces do.
  std::vector<AssemblyOperation> order = ring_on_peg();
  TriangleMesh ring = *order[0].active[0].mesh;
  const auto in_bore = [&](const std::array<int, 3>& t) {
    return std::all_of(t.begin(), t.end(), [&](int v) { return ring.vertices[v].head<2>().norm() < 0.0051; });
  };
  ring.triangles.erase(std::find_if(ring.triangles.begin(), ring.triangles.end(), in_bore));
  for (const bool inside_out : {false, true}) {
    auto triangles = ring.triangles;
    for (auto& t : triangles) {
      if (inside_out) std::swap(t[1], t[2]);
    }
    const auto open = make_mesh(ring.vertices, triangles);
    ASSERT_FALSE(open->closed);
    order[0].active[0].mesh = open;
    const PlanGrippersResult found = plan_grippers(order, kChuck);
    ASSERT_EQ(found.outcome, Outcome::solved) << inside_out;
    EXPECT_EQ(found.parts.at("ring").segmentation.turned, inside_out);
    EXPECT_NEAR(found.set->grippers[0].finger_length, 0.0325, 1e-4) << inside_out;
  }
}

TEST(PlanGrippers, DeepGraspsGiveWayWhereFingersAreShort) {
  PlanGrippersOptions options;
  options.longest_finger = 0.0315;  // 30.5 mm without the margin: 10 mm deep is the deepest
  PlanGrippersResult found = plan_grippers(ring_on_peg(), kChuck, {}, options);
  ASSERT_EQ(found.outcome, Outcome::solved);
  EXPECT_NEAR(found.grasps[found.set->requirement_of_part[0]].contact_length, 0.010, 1e-9);
  options.longest_finger = 0.0245;
  found = plan_grippers(ring_on_peg(), kChuck, {}, options);
  ASSERT_EQ(found.outcome, Outcome::solved);
  EXPECT_NEAR(found.grasps[found.set->requirement_of_part[0]].contact_length, 0.003, 1e-9);
}

TEST(PlanGrippers, WhatWouldHelpHelps) {
  PlanGrippersOptions options;
  options.longest_finger = 0.02;
  PlanGrippersResult found = plan_grippers(ring_on_peg(), kChuck, {}, options);
  EXPECT_EQ(found.outcome, Outcome::not_found);  // other directions might do
  ASSERT_EQ(found.missing.size(), 1u);
  ASSERT_EQ(found.help, std::vector<std::string>{"ring: fingers of 24 mm would do"});  // 23 mm and the margin
  options.longest_finger = 0.024;
  EXPECT_EQ(plan_grippers(ring_on_peg(), kChuck, {}, options).outcome, Outcome::solved);

  found = plan_grippers(ring_on_peg(), {{"jaws", 2, 0.02}});
  ASSERT_EQ(found.outcome, Outcome::infeasible);
  EXPECT_NE(found.missing[0].find("no actuator has 3 fingers"), std::string::npos) << found.missing[0];
  ASSERT_EQ(found.help.size(), 2u);
  EXPECT_EQ(found.help[0], "ring: a drive with 3 fingers, a stroke of 5 mm and an opening of up to 24 mm would do");
  EXPECT_EQ(found.help[1],
            "ring: a drive with 3 fingers, a stroke of 2 mm and an opening of up to 21 mm would do, the least: its "
            "fingers open by 0.5 mm, not by 2 mm");
  const double opening = std::stod(found.help[0].substr(found.help[0].find("up to ") + 6)) / 1000;
  EXPECT_NEAR(opening, 0.024, 1e-4);  // 20 mm, and 2 mm for each finger to let go
  EXPECT_EQ(plan_grippers(ring_on_peg(), {{"jaws", 2, 0.02}, {"c", 3, 0.006, opening}}).outcome, Outcome::solved);
  EXPECT_EQ(plan_grippers(ring_on_peg(), {{"c", 3, 0.006, opening - 0.0002}}).outcome, Outcome::infeasible);
  EXPECT_EQ(plan_grippers(ring_on_peg(), {{"c", 3, 0.002, 0.021}}).outcome, Outcome::solved);
}

TEST(PlanGrippers, RefuseTwoPartsOfOneNameThatStay) {
  std::vector<AssemblyOperation> order = ring_on_peg();
  order[0].passive.push_back(order[0].passive[0]);
  try {
    plan_grippers(order, kChuck);
    FAIL();
  } catch (const InvalidInput& e) {
    EXPECT_STREQ(e.what(), "operation 'ring': part 'plate' stays twice: names must differ");
  }
}

TEST(PlanGrippers, FingersKeepOffSegmentsAndBoxes) {
  std::vector<int> all;
  for (const SegmentFate& f : ring_plan().fates) all.push_back(f.segment);
  const PlanGrippersResult none = plan_grippers(ring_on_peg(), kChuck, {{"ring", all}});
  EXPECT_EQ(none.outcome, Outcome::infeasible);
  EXPECT_NE(none.missing.at(0).find("not to be touched"), std::string::npos);
  const std::vector<std::string> names = segment_names(ring_plan().parts.at("ring").primitives);
  for (std::size_t i = 0; i < all.size(); ++i) EXPECT_EQ(ring_plan().fates[i].name, names.at(all[i]));
  EXPECT_EQ(plan_grippers(ring_on_peg(), kChuck, {{"ring", {}, {}, names}}).missing, none.missing);
  EXPECT_EQ(plan_grippers(ring_on_peg(), kChuck, {{"ring", {}, {}, {"ring/" + names[0]}}}).missing, none.missing);
  try {
    plan_grippers(ring_on_peg(), kChuck, {{"ring", {}, {}, {"cylinder_9"}, "a.yaml:7"}});
    FAIL();
  } catch (const InvalidInput& e) {
    EXPECT_STREQ(e.what(),
                 "a.yaml:7: keep_off of part 'ring' = cylinder_9: must be the name of one of its segments, cylinder_1; "
                 "did you mean \"cylinder_1\"?");
  }
  // The ring's lower 5 mm: pads may come 7 mm deep, so of the depths 3, 10 and 11.5 mm the first is left.
  KeepOffBox low{at(0, 0, 0.0025), {0.05, 0.05, 0.005}};
  const PlanGrippersResult upper = plan_grippers(ring_on_peg(), kChuck, {{"ring", {}, {low}}});
  ASSERT_EQ(upper.outcome, Outcome::solved);
  for (const AssemblyGrasp& g : upper.grasps) {
    const bool from_above = g.T_active_tool.linear()(2, 2) < 0;
    EXPECT_TRUE(from_above);
    EXPECT_NEAR(g.contact_length, 0.003, 1e-9);
  }
  KeepOffBox top{at(0, 0, 0.0115), {0.05, 0.05, 0.001}};  // whoever comes from above passes it
  EXPECT_EQ(plan_grippers(ring_on_peg(), kChuck, {{"ring", {}, {top}}}).outcome, Outcome::not_found);
  EXPECT_THROW(plan_grippers(ring_on_peg(), kChuck, {{"rings"}}), InvalidInput);
  EXPECT_THROW(plan_grippers(ring_on_peg(), kChuck, {{"ring", {99}}}), InvalidInput);
  EXPECT_THROW(plan_grippers(ring_on_peg(), kChuck, {{"ring", {}, {{at(1, 0, 0), {0.01, 0.01, 0.01}}}}}), InvalidInput);
}

TEST(PlanGrippers, AnOperationThatEndsInAnotherPartIsNamed) {
  std::vector<AssemblyOperation> order = ring_on_peg();
  order[0].motion.back() = at(0, 0, -0.004);  // 4 mm into the peg's foot
  PlanGrippersResult found = plan_grippers(order, kChuck);
  EXPECT_EQ(found.outcome, Outcome::infeasible);
  EXPECT_EQ(found.missing,
            std::vector<std::string>{"ring: ring stands 4 mm deep in peg at its end (max_overlap is 0.5 mm)"});
  PlanGrippersOptions options;
  options.max_overlap = 0.005;
  EXPECT_EQ(plan_grippers(order, kChuck, {}, options).missing.size(), 0u);
  order = ring_on_peg();
  order[0].motion.front() = at(0, 0, -0.1);
  found = plan_grippers(order, kChuck);
  EXPECT_EQ(found.outcome, Outcome::infeasible);
  EXPECT_NE(found.missing.at(0).find("before its end"), std::string::npos) << found.missing[0];
}

TEST(PlanGrippers, WeightAndInsertionAreHeldOrRefused) {
  std::vector<AssemblyOperation> order = ring_on_peg();
  order[0].insertion_force = 20;
  PlanGrippersOptions options;
  options.holding.emplace();
  const PlanGrippersResult firm = plan_grippers(order, kChuck, {}, options);
  ASSERT_EQ(firm.outcome, Outcome::solved);
  ASSERT_EQ(firm.holdings.size(), firm.requirements.size());
  const HeldLoad& held = firm.holdings[firm.set->requirement_of_part[0]];
  // Three fingers carry 0.5 * 50 N each; the hole pushes 20 N upwards, the weight pulls the other way.
  const double weight = M_PI * (0.01 * 0.01 - 0.005 * 0.005) * 0.012 * 7850 * 9.81;
  EXPECT_NEAR(held.safety, 3 * 25 / (20 - weight), 1e-3);
  EXPECT_NEAR(held.insertion_moment, 0, 1e-4);
  options.holding->grip.force = 5;
  const PlanGrippersResult weak = plan_grippers(order, kChuck, {}, options);
  EXPECT_EQ(weak.outcome, Outcome::not_found);
  EXPECT_NE(weak.missing.at(0).find("pads slip"), std::string::npos);
  EXPECT_TRUE(weak.help.empty());
}

TEST(PlanGrippers, SameAnswerAtAnyNumberOfThreads) {
  PlanGrippersOptions one;
  one.threads = 1;  // the other one used all
  const PlanGrippersResult a = plan_grippers(ring_on_peg(), kChuck, {}, one);
  const PlanGrippersResult& b = ring_plan();
  ASSERT_EQ(a.requirements.size(), b.requirements.size());
  for (std::size_t i = 0; i < a.grasps.size(); ++i) {
    EXPECT_EQ(a.grasps[i].T_active_tool.matrix(), b.grasps[i].T_active_tool.matrix());
    EXPECT_EQ(a.requirements[i].min_finger_length, b.requirements[i].min_finger_length);
  }
  EXPECT_EQ(a.set->requirement_of_part, b.set->requirement_of_part);
}

TEST(PlanGrippers, MistakesAreNamedBeforeAnyWork) {
  std::vector<AssemblyOperation> twice = ring_on_peg();
  twice.push_back(twice[0]);
  EXPECT_THROW(plan_grippers(twice, kChuck), InvalidInput);
  twice[1].name = "again";
  try {
    plan_grippers(twice, kChuck);
    FAIL();
  } catch (const InvalidInput& e) {
    EXPECT_NE(std::string(e.what()).find("an order names a part once"), std::string::npos);
  }
  std::vector<AssemblyOperation> both = ring_on_peg();
  both[0].passive.push_back(both[0].active[0]);
  EXPECT_THROW(plan_grippers(both, kChuck), InvalidInput);
  EXPECT_THROW(plan_grippers({}, kChuck), InvalidInput);
  EXPECT_THROW(plan_grippers(ring_on_peg(), {}), InvalidInput);
  std::vector<AssemblyOperation> no_way = ring_on_peg();
  no_way[0].motion = {at(0, 0, 0)};
  no_way[0].insertion_force = 1;
  EXPECT_THROW(plan_grippers(no_way, kChuck), InvalidInput);
  std::vector<AssemblyOperation> nowhere = ring_on_peg();
  nowhere[0].motion[0].translation().x() = std::nan("");
  EXPECT_THROW(plan_grippers(nowhere, kChuck), InvalidInput);
  PlanGrippersOptions options;
  options.max_overlap = std::nan("");
  EXPECT_THROW(plan_grippers(ring_on_peg(), kChuck, {}, options), InvalidInput);
}

TEST(PlanGrippers, StopsWhenAsked) {
  Monitor monitor;
  std::set<std::string> stages;
  monitor.progress = [&](const std::string& stage, double) { stages.insert(stage); };
  EXPECT_EQ(plan_grippers(ring_on_peg(), kChuck, {}, {}, monitor).outcome, Outcome::solved);
  for (const char* stage : {"segments", "grasps", "rehearsal"}) EXPECT_EQ(stages.count(stage), 1u) << stage;
  monitor.progress = [&](const std::string& stage, double) {
    if (stage == "grasps") monitor.stop.stop();
  };
  const PlanGrippersResult stopped = plan_grippers(ring_on_peg(), kChuck, {}, {}, monitor);
  EXPECT_EQ(stopped.outcome, Outcome::stopped);
  EXPECT_FALSE(stopped.set);
}

/// A ring of an outer diameter is put on a plate.
AssemblyOperation ring_on_plate(const std::string& name, double diameter, double height) {
  AssemblyOperation o;
  const double inner = diameter / 4, outer = diameter / 2;
  o.name = name;
  o.active = {{name, turned({{inner, 0}, {outer, 0}, {outer, height}, {inner, height}})}};
  o.passive = {{"plate", block({0.2, 0.2, 0.005}), at(0, 0, -0.005)}};
  o.motion = {at(0, 0, 0.05), at(0, 0, 0)};
  return o;
}

TEST(PlanGrippers, ChosenGrippersOpenByThePromisedClearance) {
  const std::vector<AssemblyOperation> order{ring_on_plate("small", 0.02, 0.02), ring_on_plate("large", 0.034, 0.02)};
  PlanGrippersResult found = plan_grippers(order, kChuck);
  ASSERT_EQ(found.outcome, Outcome::solved);
  // One stroke of 16 mm takes both with the margins of 1 mm alone: 14 mm and 2 mm.
  EXPECT_EQ(found.set->grippers.size(), 2u);
  const auto expect_kept = [&](double clearance) {
    for (std::size_t i = 0; i < order.size(); ++i) {
      const Gripper& gripper = found.set->grippers[found.set->gripper_of_part[i]];
      const AssemblyGrasp& grasp = found.grasps[found.set->requirement_of_part[i]];
      EXPECT_NEAR(grasp.clearance, clearance, 1e-12);
      EXPECT_GE((gripper.max_opening - grasp.opening) / 2, clearance - 1e-6) << order[i].name;
      EXPECT_LE(gripper.min_opening + 0.001, grasp.opening + 1e-6) << order[i].name;
    }
  };
  expect_kept(0.002);
  PlanGrippersOptions options;
  options.clearance = 0.0005;
  found = plan_grippers(order, kChuck, {}, options);
  EXPECT_EQ(found.set->grippers.size(), 1u);
  expect_kept(0.0005);
  // A drive of 4 mm opens by no more than it has beside the margin.
  options.clearance = 0.002;
  found = plan_grippers(order, {{"short", 3, 0.004}}, {}, options);
  ASSERT_EQ(found.outcome, Outcome::solved);
  expect_kept(0.0015);
}

TEST(PlanGrippers, SegmentsThinnerThanTheContactAreCalledThin) {
  const std::vector<AssemblyOperation> washer{ring_on_plate("washer", 0.0125, 0.0016)};
  PlanGrippersResult found = plan_grippers(washer, kChuck);
  ASSERT_EQ(found.outcome, Outcome::infeasible);
  EXPECT_NE(found.missing.at(0).find("too thin: pads would overlap it by less than min_contact = 3 mm"),
            std::string::npos)
      << found.missing[0];
  EXPECT_EQ(found.missing[0].find("wider"), std::string::npos);
  ASSERT_EQ(found.help.size(), 1u);
  EXPECT_EQ(found.help[0].substr(0, 24), "washer: a min_contact of");
  PlanGrippersOptions options;
  options.min_contact = std::stod(found.help[0].substr(24)) / 1000;
  EXPECT_GT(options.min_contact, 0.001);
  EXPECT_LE(options.min_contact, 0.0016);
  EXPECT_EQ(plan_grippers(washer, kChuck, {}, options).outcome, Outcome::solved);
}

TEST(PlanGrippers, HoldingIsThatOfThePadsThatExist) {
  AssemblyOperation o = ring_on_plate("bead", 0.009, 0.012);
  o.insertion_force = 20;
  o.hole = Eigen::Vector3d(0.004, 0, 0);
  PlanGrippersOptions options;
  options.holding.emplace();
  options.holding->least_safety = 0;
  const OperationLoad load = operation_load(o, *options.holding);
  const auto expect_true = [&](const PlanGrippersResult& found) {
    const int taken = found.set->requirement_of_part[0];
    const AssemblyGrasp& grasp = found.grasps[taken];
    EXPECT_LE(grasp.contact_width, found.set->grippers[0].pad_width() + 1e-12);
    EXPECT_NEAR(found.holdings[taken].safety, held_load(grasp, load).safety, 1e-12);
    EXPECT_NEAR(found.holdings[taken].contact_area, held_load(grasp, load).contact_area, 1e-15);
  };
  const PlanGrippersResult loose = plan_grippers({o}, kChuck, {}, options);
  ASSERT_EQ(loose.outcome, Outcome::solved);
  EXPECT_LT(loose.set->grippers[0].pad_width(), 0.003);  // closes to 1 mm: nearly an edge
  expect_true(loose);
  // What that does not hold, wider pads may: the gripper then closes no farther than it must.
  const double narrow = loose.holdings[loose.set->requirement_of_part[0]].safety;
  AssemblyGrasp wide = loose.grasps[loose.set->requirement_of_part[0]];
  wide.contact_width = 0.013;
  ASSERT_GT(held_load(wide, load).safety, 1.01 * narrow);
  options.holding->least_safety = 1.005 * narrow;
  const PlanGrippersResult firm = plan_grippers({o}, kChuck, {}, options);
  ASSERT_EQ(firm.outcome, Outcome::solved);
  EXPECT_NEAR(firm.set->grippers[0].min_opening, 0.008, 1e-5);
  EXPECT_GE(firm.holdings[firm.set->requirement_of_part[0]].safety, options.holding->least_safety);
  expect_true(firm);
}

TEST(PlanGrippers, PadsTooNarrowInASharedGripperAskForAnotherOne) {
  std::vector<AssemblyOperation> order{ring_on_plate("pin", 0.003, 0.012), ring_on_plate("bead", 0.009, 0.012)};
  order[1].insertion_force = 20;
  order[1].hole = Eigen::Vector3d(0.004, 0, 0);
  PlanGrippersOptions options;
  options.holding.emplace();
  options.holding->least_safety = 0;
  const PlanGrippersResult shared = plan_grippers(order, kChuck, {}, options);
  ASSERT_EQ(shared.outcome, Outcome::solved);
  ASSERT_EQ(shared.set->grippers.size(), 1u);
  options.holding->least_safety = 1.01 * shared.holdings[shared.set->requirement_of_part[1]].safety;
  const PlanGrippersResult apart = plan_grippers(order, kChuck, {}, options);
  ASSERT_EQ(apart.outcome, Outcome::solved);
  EXPECT_EQ(apart.set->grippers.size(), 2u);
  EXPECT_TRUE(apart.left_out.empty());
  EXPECT_GE(apart.holdings[apart.set->requirement_of_part[1]].safety, options.holding->least_safety);
}

TEST(PlanGrippers, ARehearsalThatWasStoppedHasMetNothingYet) {
  std::vector<AssemblyOperation> order;
  for (int i = 0; i < 4; ++i) order.push_back(ring_on_plate("ring_" + std::to_string(i), 0.02, 0.012));
  Monitor monitor;
  monitor.progress = [&](const std::string& stage, double) {
    if (stage == "rehearsal") monitor.stop.stop();
  };
  PlanGrippersOptions options;
  options.threads = 1;
  const PlanGrippersResult found = plan_grippers(order, kChuck, {}, options, monitor);
  EXPECT_EQ(found.outcome, Outcome::stopped);
  EXPECT_TRUE(found.met.empty());
}

TEST(RehearseOperation, MeetsWhatTooShortFingersWould) {
  const std::vector<AssemblyOperation> order = ring_on_peg();
  const PlanGrippersResult& found = ring_plan();
  const AssemblyGrasp& grasp = found.grasps[found.set->requirement_of_part[0]];
  Gripper gripper = found.set->grippers[0];
  EXPECT_EQ(rehearse_operation(gripper, grasp, order[0]), "");
  gripper.finger_length = found.requirements[found.set->requirement_of_part[0]].min_finger_length - 0.001;
  EXPECT_EQ(rehearse_operation(gripper, grasp, order[0]), "base meets peg during the motion");
}

TEST(RehearseOperation, OpenFingersMayJustTouchAndComeWhereTheMotionBegins) {
  AssemblyOperation o;
  o.active = {{"bar", block({0.005, 0.02, 0.01}), Pose::Identity()}};
  AssemblyGrasp grasp;
  grasp.opening = 0.01;
  grasp.T_active_tool.linear() = Eigen::Vector3d(1, -1, -1).asDiagonal();
  Gripper gripper;
  gripper.max_opening = 0.02;
  gripper.finger_length = 0.08;
  const double open = 0.005 + grasp.clearance + gripper.finger_thickness;
  const auto walls_at = [&](double gap, double height) {
    o.passive = {{"wall", block({0.003, 0.05, 0.03}), at(gap + 0.003, 0, height)}};
    return rehearse_operation(gripper, grasp, o);
  };
  o.motion = {at(0, 0, 0.3), at(0, 0, 0)};
  EXPECT_EQ(walls_at(open, 0), "");  // just touched when the bar is let go
  EXPECT_EQ(walls_at(open - 1e-4, 0), "finger_1 meets wall during letting go");
  EXPECT_EQ(walls_at(open, 0.3), "base meets wall during the motion");  // the palm, which comes down past it
  EXPECT_EQ(walls_at(open - 1e-4, 0.3), "finger_1 meets wall during the approach");
}

TEST(RehearseOperation, EndsWhenInterrupted) {
  const PlanGrippersResult& found = ring_plan();
  CancelToken stop;
  stop.stop();
  const detail::InterruptionScope scope(stop);
  EXPECT_THROW(
      rehearse_operation(found.set->grippers[0], found.grasps[found.set->requirement_of_part[0]], ring_on_peg()[0]),
      detail::Interrupted);
}

TEST(RehearseOperation, TurningPartsTakeTheGripperRoundTheirMiddle) {
  AssemblyOperation o;
  o.active = {{"bar", block({0.15, 0.005, 0.005}), at(0.3, 0.2, 0)}};
  Pose turn = Pose::Identity();
  turn.linear() = Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  turn.translation() = at(0.3, 0.2, 0).translation() - turn.linear() * at(0.3, 0.2, 0).translation();
  o.motion = {turn, at(0, 0, 0)};
  AssemblyGrasp grasp;
  grasp.opening = 0.01;
  grasp.T_active_tool = at(0.44, 0.2, 0);
  grasp.T_active_tool.linear() << 0, 1, 0, 1, 0, 0, 0, 0, -1;
  Gripper gripper;
  gripper.max_opening = 0.02;
  const double half = std::sqrt(0.5);
  o.passive = {{"pin", block({0.002, 0.002, 0.1}), at(0.3 + 0.14 * half, 0.2 + 0.14 * half, 0.1)}};
  const std::string met = rehearse_operation(gripper, grasp, o);
  EXPECT_NE(met.find("meets pin during the motion"), std::string::npos) << met;
  o.passive[0].pose = at(0.37, 0.27, 0.1);
  EXPECT_EQ(rehearse_operation(gripper, grasp, o), "");
}

}  // namespace
}  // namespace mmgrasp
