#include "mmgrasp/gripper_design/minimal_grippers.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"

namespace mmgrasp {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

SegmentRequirement segment(const std::string& part, int fingers, double opening, double shortest = 0,
                           double longest = kInfinite) {
  return {part, "", fingers, opening, shortest, longest};
}

/// Figure 5.13 of P1 in millimetres at full size; part 7 has one of its eight segments twice removed: all widths count.
std::vector<SegmentRequirement> figure_5_13(double scale) {
  struct Row {
    const char* part;
    int fingers;
    double opening, shortest;
  };
  const Row rows[] = {{"1", 3, 227, 0},  {"2", 3, 227, 0},  {"3", 3, 110, 0},   {"4", 3, 25, 0},
                      {"5", 3, 32, 0},   {"5", 3, 40, 41},  {"6", 3, 18, 0},    {"7", 2, 16.7, 0},
                      {"7", 2, 19.1, 0}, {"7", 2, 17.2, 0}, {"7", 2, 15.9, 0},  {"7", 2, 16.5, 0},
                      {"7", 2, 15.8, 0}, {"7", 2, 16.9, 0}, {"7", 2, 18.5, 0},  {"8", 2, 60, 0},
                      {"8", 3, 40, 50},  {"9", 3, 32, 0},   {"9", 3, 40, 41},   {"10", 2, 17, 4.5},
                      {"11", 3, 20, 0},  {"12", 2, 15, 0},  {"12", 2, 32.8, 0}, {"13", 3, 37.5, 22.7}};
  std::vector<SegmentRequirement> out;
  for (const Row& r : rows) {
    out.push_back(segment(r.part, r.fingers, 1e-3 * scale * r.opening, 1e-3 * scale * r.shortest));
  }
  return out;
}

const std::vector<GripperActuator> kAirChucks{{"SMC MHF2-12D2", 2, 0.048}, {"SMC MHSL3-32D", 3, 0.008}};

/// Least cost, then fewest changes, by trying every set of grippers at every pair of ends: openings that begin or end
/// at a segment's width, finger lengths at either limit.
struct BruteForce {
  struct Candidate {
    double cost;
    unsigned parts;
  };
  std::vector<Candidate> candidates;
  std::vector<std::string> parts;

  BruteForce(const std::vector<SegmentRequirement>& requirements, const std::vector<GripperActuator>& actuators,
             const MinimalGrippersOptions& options) {
    for (const auto& r : requirements) {
      if (std::find(parts.begin(), parts.end(), r.part) == parts.end()) parts.push_back(r.part);
    }
    for (const auto& a : actuators) {
      std::vector<double> lows{0, a.max_opening - a.stroke}, lengths{options.shortest_finger, options.longest_finger};
      for (const auto& r : requirements) {
        for (const double low : {r.opening, r.opening - a.stroke}) lows.push_back(low);
        for (const double length : {r.min_finger_length, r.max_finger_length}) lengths.push_back(length);
      }
      for (const double low : lows) {
        if (low < 0 || !(low + a.stroke <= a.max_opening + 1e-9)) continue;
        for (const double length : lengths) {
          if (length < options.shortest_finger || length > options.longest_finger) continue;
          add(requirements, a, low, length);
        }
      }
    }
  }

  void add(const std::vector<SegmentRequirement>& requirements, const GripperActuator& a, double low, double length) {
    unsigned mask = 0;
    for (const auto& r : requirements) {
      const bool holds = r.fingers == a.fingers && low <= r.opening + 1e-9 && r.opening <= low + a.stroke + 1e-9 &&
                         r.min_finger_length <= length && length <= r.max_finger_length;
      if (holds) mask |= 1u << (std::find(parts.begin(), parts.end(), r.part) - parts.begin());
    }
    for (const auto& c : candidates) {
      if (c.parts == mask && c.cost == a.cost) return;
    }
    if (mask) candidates.push_back({a.cost, mask});
  }

  int changes(const std::vector<int>& chosen) const {
    std::vector<int> best(chosen.size(), 0);
    for (std::size_t p = 0; p < parts.size(); ++p) {
      const int least = *std::min_element(best.begin(), best.end());
      for (std::size_t g = 0; g < chosen.size(); ++g) {
        const bool takes = candidates[chosen[g]].parts >> p & 1;
        best[g] = takes ? std::min(best[g], least + (p > 0)) : 1000;
      }
    }
    return *std::min_element(best.begin(), best.end());
  }

  std::pair<double, int> least(double change_cost) const {
    std::pair<double, int> best{kInfinite, 0};
    std::vector<int> chosen;
    search(0, 0, 0, change_cost, chosen, best);
    return best;
  }

  void search(std::size_t next, unsigned covered, double cost, double change_cost, std::vector<int>& chosen,
              std::pair<double, int>& best) const {
    if (cost > best.first + 1e-9) return;
    if (covered == (1u << parts.size()) - 1) {
      const int needed = changes(chosen);
      const double total = cost + change_cost * needed;
      if (total < best.first - 1e-9 || (total < best.first + 1e-9 && needed < best.second)) best = {total, needed};
    }
    for (std::size_t g = next; g < candidates.size(); ++g) {
      chosen.push_back(static_cast<int>(g));
      search(g + 1, covered | candidates[g].parts, cost + candidates[g].cost, change_cost, chosen, best);
      chosen.pop_back();
    }
  }
};

void expect_complete(const MinimalGrippersResult& r, const std::vector<SegmentRequirement>& requirements) {
  ASSERT_EQ(r.gripper_of_part.size(), r.parts.size());
  int changes = 0;
  for (std::size_t p = 0; p < r.parts.size(); ++p) {
    const SegmentRequirement& taken = requirements.at(r.requirement_of_part[p]);
    EXPECT_EQ(taken.part, r.parts[p]);
    EXPECT_TRUE(r.grippers.at(r.gripper_of_part[p]).holds(taken)) << taken.name();
    changes += p > 0 && r.gripper_of_part[p] != r.gripper_of_part[p - 1];
  }
  EXPECT_EQ(changes, r.changes);
}

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
