// Each part is taken by its best segment as long as the set stays as good.
#include "mmgrasp/gripper_design/minimal_grippers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "gripper_design/every_set.hpp"
#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"

namespace mmgrasp {
namespace {

using namespace test;

TEST(PreferredGrippers, TakeTheBestSegmentThatNoMoreGrippersAsk) {
  // a by either segment with one gripper; c's better segment would ask for a gripper of its own.
  const std::vector<SegmentRequirement> requirements{segment("a", 2, 0.020), segment("b", 2, 0.024),
                                                     segment("a", 2, 0.026), segment("c", 2, 0.022),
                                                     segment("c", 2, 0.090)};
  const std::vector<GripperActuator> jaws{{"jaws", 2, 0.010}};
  const MinimalGrippersResult r = preferred_grippers(requirements, {1, 1, 2, 1, 5}, jaws);
  EXPECT_EQ(r.outcome, Outcome::solved);
  EXPECT_EQ(r.parts, (std::vector<std::string>{"a", "b", "c"}));
  EXPECT_EQ(r.requirement_of_part, (std::vector<int>{2, 1, 3}));
  EXPECT_EQ(r.grippers.size(), 1u);
  EXPECT_EQ(r.lower_bound, 1);
  EXPECT_EQ(preferred_grippers(requirements, {2, 1, 1, 1, 0}, jaws).requirement_of_part, (std::vector<int>{0, 1, 3}));
  EXPECT_THROW(preferred_grippers(requirements, {1, 2}, jaws), InvalidInput);
}

TEST(PreferredGrippers, CostNoMoreAndChangeNoMoreOftenThanTheLeastSet) {
  Rng rng(11);
  int bettered = 0;
  for (int k = 0; k < 40; ++k) {
    std::vector<SegmentRequirement> requirements;
    std::vector<double> values;
    for (int p = 0; p < 8; ++p) {
      for (int s = 0; s < 3; ++s) {
        requirements.push_back(segment(std::to_string(p), 2 + s % 2, rng.uniform(0.01, 0.1)));
        values.push_back(rng.uniform(0, 1));
      }
    }
    const std::vector<GripperActuator> drives{{"jaws", 2, 0.020}, {"centric", 3, 0.020}};
    const MinimalGrippersResult least = minimal_grippers(requirements, drives);
    const MinimalGrippersResult best = preferred_grippers(requirements, values, drives);
    EXPECT_EQ(best.cost, least.cost);
    EXPECT_LE(best.changes, least.changes);
    expect_complete(best, requirements);
    double before = 0, after = 0;
    for (int p = 0; p < 8; ++p) {
      before += values[least.requirement_of_part[p]];
      after += values[best.requirement_of_part[p]];
    }
    bettered += after > before;
  }
  EXPECT_GT(bettered, 20);
}

TEST(PreferredGrippers, CostsInAnyUnitHaveTheSameAnswer) {
  const std::vector<SegmentRequirement> requirements{segment("a", 2, 0.020), segment("a", 2, 0.090)};
  for (const double unit : {1.0, 1e-12, 1e12}) {
    const std::vector<GripperActuator> drives{{"cheap", 2, 0.01, 0.05, unit}, {"dear", 2, 0.01, 0.2, 3 * unit}};
    const MinimalGrippersResult r = preferred_grippers(requirements, {1, 5}, drives);
    EXPECT_NEAR(r.cost / unit, 1, 1e-9) << unit;
    EXPECT_NEAR(r.lower_bound / unit, 1, 1e-9) << unit;
    EXPECT_EQ(r.requirement_of_part, std::vector<int>{0}) << unit;
    EXPECT_TRUE(r.preference_finished);
  }
}

/// The best values, part by part, that sets as good as the least one allow: by solving the whole problem again for
/// each.
std::vector<double> values_by_solving_again(std::vector<SegmentRequirement> requirements, std::vector<double> values,
                                            const std::vector<GripperActuator>& drives,
                                            const MinimalGrippersOptions& options) {
  const MinimalGrippersResult least = minimal_grippers(requirements, drives, options);
  std::vector<double> out;
  for (const std::string& part : least.parts) {
    std::vector<int> ways;
    for (std::size_t r = 0; r < requirements.size(); ++r)
      if (requirements[r].part == part) ways.push_back(static_cast<int>(r));
    std::stable_sort(ways.begin(), ways.end(), [&](int a, int b) { return values[a] > values[b]; });
    for (const int way : ways) {
      std::vector<SegmentRequirement> left;
      std::vector<double> worth;
      for (std::size_t r = 0; r < requirements.size(); ++r) {
        if (requirements[r].part == part && static_cast<int>(r) != way) continue;
        left.push_back(requirements[r]);
        worth.push_back(values[r]);
      }
      const MinimalGrippersResult again = minimal_grippers(left, drives, options);
      // The order of assembly stays: parts are first named in the same order.
      if (again.grippers.empty() || again.cost > least.cost + 1e-9 || again.changes > least.changes) continue;
      out.push_back(values[way]);
      requirements = left;
      values = worth;
      break;
    }
  }
  return out;
}

TEST(PreferredGrippers, AreAsGoodAsSolvingAgainForEverySegment) {
  Rng rng(23);
  int sums = 0;
  for (int trial = 0; trial < 60; ++trial) {
    std::vector<SegmentRequirement> requirements;
    std::vector<double> values;
    for (int p = 0; p < 7; ++p) {
      for (int s = 0; s < 3; ++s) {
        const double shortest = trial % 2 ? rng.uniform(0, 0.04) : 0.0;
        requirements.push_back(segment(std::to_string(p), 2 + static_cast<int>(rng.index(2)), rng.uniform(0.01, 0.08),
                                       shortest, trial % 2 ? shortest + rng.uniform(0.005, 0.05) : kInfinite));
        values.push_back(rng.uniform(0, 1));
      }
    }
    std::vector<GripperActuator> drives{{"jaws", 2, 0.020}, {"centric", 3, 0.015}};
    if (trial % 3 == 1) drives[1].cost = 1.4;
    MinimalGrippersOptions options;
    options.change_cost = trial % 5 == 1 ? 0.3 : 0.0;
    const MinimalGrippersResult best = preferred_grippers(requirements, values, drives, options);
    ASSERT_EQ(best.outcome, Outcome::solved);
    EXPECT_TRUE(best.preference_finished);
    expect_complete(best, requirements);
    const std::vector<double> wanted = values_by_solving_again(requirements, values, drives, options);
    ASSERT_EQ(wanted.size(), best.parts.size());
    for (std::size_t p = 0; p < wanted.size(); ++p)
      EXPECT_EQ(values[best.requirement_of_part[p]], wanted[p]) << trial << " " << best.parts[p];
    sums += best.changes;
  }
  EXPECT_GT(sums, 0);
}

/// Parts of one to four segments, 5 to 200 mm wide (evenly in the logarithm), a quarter of which ask for long fingers.
std::vector<SegmentRequirement> random_parts(int count, Rng& rng) {
  std::vector<SegmentRequirement> out;
  for (int p = 0; p < count; ++p) {
    const int segments = 1 + static_cast<int>(rng.index(4));
    for (int s = 0; s < segments; ++s)
      out.push_back(segment(std::to_string(p), 2 + static_cast<int>(rng.index(2)),
                            1e-4 * std::round(50 * std::exp(rng.uniform(0, std::log(40.0)))),
                            rng.uniform() < 0.25 ? rng.uniform(0.01, 0.06) : 0));
  }
  return out;
}

TEST(PreferredGrippers, EveryBetterSegmentOfTwoHundredPartsIsDecided) {
  for (const double stroke : {0.008, 0.024, 0.048}) {
    Rng rng(200);
    const std::vector<SegmentRequirement> requirements = random_parts(200, rng);
    std::vector<double> values(requirements.size());
    for (double& v : values) v = rng.uniform();
    const MinimalGrippersResult best =
        preferred_grippers(requirements, values, {{"jaws", 2, stroke}, {"centric", 3, stroke}});
    EXPECT_EQ(best.outcome, Outcome::solved) << stroke;
    EXPECT_EQ(best.changes, best.changes_bound) << stroke;
    EXPECT_TRUE(best.preference_finished) << stroke;
    expect_complete(best, requirements);
  }
}

TEST(PreferredGrippers, SayThatTheyAreNotFinished) {
  Rng rng(1);
  std::vector<SegmentRequirement> requirements;
  std::vector<double> values;
  for (int p = 0; p < 60; ++p) {
    for (int s = 0; s < 4; ++s) {
      requirements.push_back(segment(std::to_string(p), 2 + s % 2, rng.uniform(0.01, 0.2)));
      values.push_back(rng.uniform(0, 1));
    }
  }
  MinimalGrippersOptions options;
  options.max_nodes = 3;
  const std::vector<GripperActuator> drives{{"jaws", 2, 0.020}, {"centric", 3, 0.020}};
  const MinimalGrippersResult one = preferred_grippers(requirements, values, drives, options);
  EXPECT_FALSE(one.preference_finished);
  expect_complete(one, requirements);
  const MinimalGrippersResult two = preferred_grippers(requirements, values, drives, options);
  EXPECT_EQ(one.requirement_of_part, two.requirement_of_part);
  EXPECT_EQ(one.gripper_of_part, two.gripper_of_part);
}

}  // namespace
}  // namespace mmgrasp
