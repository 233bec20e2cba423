#include "mmgrasp/gripper_design/minimal_grippers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "gripper_design/every_set.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"

namespace mmgrasp {
namespace {

using namespace test;

TEST(MinimalGrippers, FigureFiveThirteenNeedsFiveNotFour) {
  const auto requirements = figure_5_13(0.55);
  const MinimalGrippersResult r = minimal_grippers(requirements, kAirChucks);
  EXPECT_EQ(r.outcome, Outcome::solved);
  ASSERT_EQ(r.grippers.size(), 5u);
  EXPECT_DOUBLE_EQ(r.lower_bound, 5);
  expect_complete(r, requirements);

  // The four that P1 prints, with its finger length: {2, 0, 33, 30}, {3, 14, 22, 30}, {3, 52.5, 60.5, 30},
  // {3, 116.9, 124.9, 30} leave parts 4, 6 and 11.
  std::vector<std::string> left_out;
  for (const std::string& part : r.parts) {
    bool taken = false;
    for (const auto& [fingers, low, high] :
         {std::tuple{2, 0., 33.}, std::tuple{3, 14., 22.}, std::tuple{3, 52.5, 60.5}, std::tuple{3, 116.9, 124.9}}) {
      Gripper gripper;
      gripper.fingers = fingers;
      gripper.min_opening = 1e-3 * low;
      gripper.max_opening = 1e-3 * high;
      gripper.finger_length = 0.030;
      for (const auto& requirement : requirements) taken |= requirement.part == part && gripper.holds(requirement);
    }
    if (!taken) left_out.push_back(part);
  }
  EXPECT_EQ(left_out, (std::vector<std::string>{"4", "6", "11"}));
}

TEST(MinimalGrippers, FingerLengthsFollowFromWhatIsTaken) {
  // Part 13 alone needs fingers of 22.7 mm, part 8 by its cylinder 50 mm: held by its 60 mm faces it needs none.
  const auto requirements = figure_5_13(1.0);
  const MinimalGrippersResult r = minimal_grippers(requirements, kAirChucks);
  for (std::size_t p = 0; p < r.parts.size(); ++p) {
    if (r.parts[p] == "13") {
      EXPECT_GE(r.grippers[r.gripper_of_part[p]].finger_length, 0.0227);
    }
  }
}

TEST(MinimalGrippers, EqualsTryingEverySet) {
  Rng rng(7);
  int several_changes = 0;
  for (int trial = 0; trial < 400; ++trial) {
    std::vector<GripperActuator> actuators{{"jaws", 2, 0.01 * (1 + static_cast<double>(rng.index(3)))},
                                           {"centric", 3, 0.008}};
    if (trial % 3 == 1) actuators[0].cost = 1.5;
    if (trial % 4 == 1) actuators[1].max_opening = 0.05;
    if (trial % 5 == 1) actuators.push_back({"long jaws", 2, 0.04, kInfinite, 2.5});
    std::vector<SegmentRequirement> requirements;
    const int parts = 1 + static_cast<int>(rng.index(7));
    for (int p = 0; p < parts; ++p) {
      const int segments = 1 + static_cast<int>(rng.index(2));
      for (int s = 0; s < segments; ++s) {
        const double opening = 0.001 * (1 + static_cast<double>(rng.index(60)));
        const double shortest = trial % 2 ? 0.001 * static_cast<double>(rng.index(40)) : 0.0;
        const double longest = rng.uniform() < 0.4 ? shortest + 0.001 * static_cast<double>(rng.index(30)) : kInfinite;
        requirements.push_back(segment(std::to_string(p), rng.uniform() < 0.6 ? 2 : 3, opening, shortest, longest));
        if (trial % 4 == 3) requirements.back().least_min_opening = rng.uniform(0, opening);
        if (trial % 3 == 2 && rng.uniform() < 0.5) requirements.back().max_stroke = 0.02;
        if (trial % 7 == 2) requirements.back().clearance = 0.001 * ((p + s) % 3);  // unequal ones
      }
    }
    MinimalGrippersOptions options;
    options.change_cost = trial % 6 == 1 ? 0.3 : 0.0;
    const BruteForce brute(requirements, actuators, options);
    const auto [cost, changes] = brute.least(options.change_cost);
    const MinimalGrippersResult r = minimal_grippers(requirements, actuators, options);
    if (cost == kInfinite) {
      EXPECT_EQ(r.outcome, Outcome::infeasible) << trial;
      EXPECT_EQ(r.uncovered.size(), r.explanations.size());
      EXPECT_FALSE(r.uncovered.empty());
      continue;
    }
    ASSERT_EQ(r.outcome, Outcome::solved) << trial;
    EXPECT_NEAR(r.cost, cost, 1e-9) << trial;
    EXPECT_NEAR(r.lower_bound, cost, 1e-6) << trial;
    EXPECT_EQ(r.changes, changes) << trial;
    EXPECT_EQ(r.changes_bound, changes) << trial;
    expect_complete(r, requirements);
    several_changes += changes > 1;
  }
  EXPECT_GT(several_changes, 60);
}

TEST(MinimalGrippers, CostsInAnyUnitHaveTheSameAnswer) {
  Rng rng(11);
  for (int trial = 0; trial < 60; ++trial) {
    std::vector<SegmentRequirement> requirements;
    for (int p = 0; p < 7; ++p) {
      for (int s = 0; s < 2; ++s)
        requirements.push_back(
            segment(std::to_string(p), 2, rng.uniform(0.005, 0.08), rng.uniform(0.01, 0.03), rng.uniform(0.03, 0.08)));
    }
    std::vector<GripperActuator> actuators{
        {"a", 2, 0.012, 0.1, 1}, {"b", 2, 0.025, 0.1, 2}, {"c", 2, 0.04, 0.1, trial % 2 ? 3 : 2.77}};
    MinimalGrippersOptions options;
    options.change_cost = trial % 3 ? 0 : 0.3;
    const auto [cost, changes] = BruteForce(requirements, actuators, options).least(options.change_cost);
    for (const double unit : {1e-12, 1.0, 1e12}) {
      std::vector<GripperActuator> priced = actuators;
      MinimalGrippersOptions other = options;
      for (GripperActuator& a : priced) a.cost *= unit;
      other.change_cost *= unit;
      other.time_limit = 20;
      const MinimalGrippersResult r = minimal_grippers(requirements, priced, other);
      ASSERT_EQ(r.outcome, Outcome::solved) << trial << " " << unit;
      EXPECT_NEAR(r.cost / unit, cost, 1e-9) << trial << " " << unit;
      EXPECT_EQ(r.changes, changes) << trial << " " << unit;
    }
  }
}

TEST(MinimalGrippers, RefusesCostsThatTheProofWouldNotTellApart) {
  const std::vector<SegmentRequirement> requirements{segment("a", 2, 0.02)};
  EXPECT_THROW(minimal_grippers(requirements, {{"cheap", 2, 0.01, kInfinite, 1}, {"dear", 2, 0.01, kInfinite, 1.1e6}}),
               InvalidInput);
}

TEST(MinimalGrippers, GridIsNeverBetterThanExact) {
  const auto requirements = figure_5_13(0.55);
  for (const int n : {2, 5, 20, 100}) {
    MinimalGrippersOptions options;
    options.grid_openings = n;
    options.grid_lengths = 3;
    const MinimalGrippersResult r = minimal_grippers(requirements, kAirChucks, options);
    if (r.outcome == Outcome::infeasible) continue;
    EXPECT_GE(r.grippers.size(), 5u) << n;
    expect_complete(r, requirements);
  }
}

TEST(MinimalGrippers, ChangesCanBePaidForByMoreGrippers) {
  // Narrow and wide parts in turn: two grippers, five changes; one drive takes both, at twice the price.
  std::vector<SegmentRequirement> requirements;
  for (int p = 0; p < 6; ++p) requirements.push_back(segment(std::to_string(p), 2, p % 2 ? 0.05 : 0.01));
  const std::vector<GripperActuator> actuators{{"short", 2, 0.01}, {"long", 2, 0.05, kInfinite, 2.5}};
  MinimalGrippersOptions options;
  const MinimalGrippersResult cheap = minimal_grippers(requirements, actuators, options);
  EXPECT_EQ(cheap.grippers.size(), 2u);
  EXPECT_EQ(cheap.changes, 5);
  options.change_cost = 0.2;
  const MinimalGrippersResult quick = minimal_grippers(requirements, actuators, options);
  EXPECT_EQ(quick.grippers.size(), 1u);
  EXPECT_EQ(quick.changes, 0);
  EXPECT_DOUBLE_EQ(quick.cost, 2.5);
}

TEST(MinimalGrippers, EndsOfStrokesAndMargins) {
  const std::vector<GripperActuator> jaws{{"jaws", 2, 0.010}};
  const std::vector<SegmentRequirement> requirements{segment("a", 2, 0.020), segment("b", 2, 0.030)};
  EXPECT_EQ(minimal_grippers(requirements, jaws).grippers.size(), 1u);  // Exactly the stroke apart.
  MinimalGrippersOptions options;
  options.opening_margin = 0.0005;
  EXPECT_EQ(minimal_grippers(requirements, jaws, options).grippers.size(), 2u);
  options.opening_margin = 0.006;
  const MinimalGrippersResult none = minimal_grippers(requirements, jaws, options);
  EXPECT_EQ(none.outcome, Outcome::infeasible);
  EXPECT_NE(none.explanations.at(0).find("opening_margin"), std::string::npos);
  options.opening_margin = 0;
  options.longest_finger = 0.03;
  const MinimalGrippersResult deep = minimal_grippers({segment("pin", 2, 0.02, 0.041)}, jaws, options);
  EXPECT_EQ(deep.outcome, Outcome::infeasible);
  EXPECT_EQ(deep.uncovered, std::vector<std::string>{"pin"});
  EXPECT_NE(deep.explanations.at(0).find("41 mm"), std::string::npos) << deep.explanations.at(0);
}

TEST(MinimalGrippers, RefusesWhatCannotBe) {
  const std::vector<GripperActuator> jaws{{"jaws", 2, 0.010}};
  EXPECT_THROW(minimal_grippers({}, jaws), InvalidInput);
  EXPECT_THROW(minimal_grippers({segment("a", 2, 0.02)}, {}), InvalidInput);
  EXPECT_THROW(minimal_grippers({segment("a", 4, 0.02)}, jaws), InvalidInput);
  EXPECT_THROW(minimal_grippers({segment("a", 2, -0.02)}, jaws), InvalidInput);
  EXPECT_THROW(minimal_grippers({segment("a", 2, 0.02, 0.05, 0.04)}, jaws), InvalidInput);
  EXPECT_THROW(minimal_grippers({segment("a", 2, 0.02)}, {{"jaws", 2, 0.01}, {"jaws", 2, 0.02}}), InvalidInput);
  MinimalGrippersOptions options;
  options.grid_openings = 3;
  EXPECT_THROW(minimal_grippers({segment("a", 2, 0.02)}, jaws, options), InvalidInput);
}

TEST(MinimalGrippers, StopsWhenAsked) {
  std::vector<SegmentRequirement> requirements;
  for (int p = 0; p < 6; ++p) requirements.push_back(segment(std::to_string(p), 2, p % 2 ? 0.05 : 0.01));
  Monitor monitor;
  monitor.stop.stop();
  const MinimalGrippersResult r =
      minimal_grippers(requirements, {{"short", 2, 0.01}, {"long", 2, 0.05, kInfinite, 2.5}}, {}, monitor);
  EXPECT_EQ(r.outcome, Outcome::stopped);
  if (!r.grippers.empty()) expect_complete(r, requirements);
}

TEST(MinimalGrippers, GridsReachWhatMarginsAskFor) {
  const std::vector<SegmentRequirement> requirements{segment("a", 2, 0.02, 0.02, 0.03), segment("b", 2, 0.03, 0.025)};
  MinimalGrippersOptions options;
  options.grid_openings = 5;
  options.grid_lengths = 3;
  options.opening_margin = 0.001;
  options.length_margin = 0.001;
  const MinimalGrippersResult r = minimal_grippers(requirements, {{"jaws", 2, 0.02}}, options);
  EXPECT_EQ(r.outcome, Outcome::solved);
  expect_complete(r, requirements);
  options.opening_margin = 0.011;
  const MinimalGrippersResult none = minimal_grippers(requirements, {{"jaws", 2, 0.02}}, options);
  ASSERT_EQ(none.outcome, Outcome::infeasible);
  EXPECT_NE(none.explanations.at(0).find("opening_margin"), std::string::npos) << none.explanations[0];
}

TEST(MinimalGrippers, KeepTwiceTheClearanceAboveAPart) {
  std::vector<SegmentRequirement> requirements{segment("a", 2, 0.020), segment("b", 2, 0.027)};
  const std::vector<GripperActuator> jaws{{"jaws", 2, 0.010, 0.05}};
  EXPECT_EQ(minimal_grippers(requirements, jaws).grippers.size(), 1u);
  for (SegmentRequirement& r : requirements) r.clearance = 0.002;
  const MinimalGrippersResult two = minimal_grippers(requirements, jaws);
  ASSERT_EQ(two.grippers.size(), 2u);
  for (int p = 0; p < 2; ++p)
    EXPECT_GE(two.grippers[two.gripper_of_part[p]].max_opening, requirements[p].opening + 0.004 - 1e-9);
  requirements[1].opening = 0.047;
  EXPECT_EQ(minimal_grippers(requirements, jaws).uncovered, std::vector<std::string>{"b"});
  requirements[1].clearance = -1;
  EXPECT_THROW(minimal_grippers(requirements, jaws), InvalidInput);
}

TEST(MinimalGrippers, CloseNoFartherThanARequirementAllows) {
  std::vector<SegmentRequirement> requirements{segment("a", 3, 0.003), segment("b", 3, 0.009)};
  const std::vector<GripperActuator> chuck{{"chuck", 3, 0.016, 0.05}};
  EXPECT_EQ(minimal_grippers(requirements, chuck).grippers.size(), 1u);
  requirements[1].least_min_opening = 0.003;
  EXPECT_EQ(minimal_grippers(requirements, chuck).grippers.size(), 1u);
  requirements[1].least_min_opening = 0.0031;
  const MinimalGrippersResult two = minimal_grippers(requirements, chuck);
  ASSERT_EQ(two.grippers.size(), 2u);
  expect_complete(two, requirements);
  const Gripper& open = two.grippers[two.gripper_of_part[1]];
  EXPECT_NEAR(open.min_opening, 0.009, 1e-12);  // as wide as can be: the pads are the wider
  EXPECT_FALSE(two.grippers[two.gripper_of_part[0]].holds(requirements[1]));
  const MinimalGrippersResult none = minimal_grippers(requirements, {{"narrow", 3, 0.016, 0.018}});
  EXPECT_EQ(none.explanations,
            std::vector<std::string>{"part 'b': its gripper must not close below 3.1 mm, those that take it do"});
  requirements[1].least_min_opening = 0.0091;
  EXPECT_THROW(minimal_grippers(requirements, chuck), InvalidInput);
}

TEST(MinimalGrippers, SayEachReasonOnceAndWhatIsAskedFor) {
  std::vector<SegmentRequirement> requirements(3, segment("a", 2, 0.1));
  for (SegmentRequirement& r : requirements) r.clearance = 0.002;
  requirements[1].segment = "rim";
  EXPECT_EQ(
      minimal_grippers(requirements, {{"jaws", 2, 0.03, 0.102}}).explanations,
      std::vector<std::string>{
          "part 'a': it is 100 mm wide and asks for an opening of 104 mm, actuators with 2 fingers open to 102 mm "
          "(2 times); segment 'rim': it is 100 mm wide and asks for an opening of 104 mm, actuators with 2 fingers "
          "open to 102 mm"});
  EXPECT_EQ(minimal_grippers(requirements, {{"jaws", 2, 0.03, 0.104}}).outcome, Outcome::solved);
}

TEST(MinimalGrippers, StopWhileGrippersToChooseAmongAreMade) {
  Rng rng(1);
  std::vector<SegmentRequirement> requirements;
  for (int i = 0; i < 3000; ++i) {
    const double shortest = rng.uniform(0, 0.05);
    requirements.push_back(segment(std::to_string(i / 3), 2 + i % 2, rng.uniform(0.005, 0.2), shortest,
                                   shortest + rng.uniform(0.005, 0.05)));
  }
  Monitor monitor;
  std::vector<std::string> stages;
  monitor.progress = [&](const std::string& stage, double) {
    stages.push_back(stage);
    monitor.stop.stop();
  };
  const MinimalGrippersResult r =
      minimal_grippers(requirements, {{"jaws", 2, 0.02}, {"centric", 3, 0.02}}, {}, monitor);
  EXPECT_EQ(r.outcome, Outcome::stopped);
  EXPECT_EQ(stages, std::vector<std::string>{"grippers to choose among"});
  EXPECT_EQ(r.candidates, 0);
}

}  // namespace
}  // namespace mmgrasp
