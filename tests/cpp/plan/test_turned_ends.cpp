#include "plan/manipulation/common/turned_ends.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "mmgrasp/core/random.hpp"
#include "support/limited_arm.hpp"

namespace mmgrasp::detail {
namespace {

using Eigen::VectorXd;
using Path = std::vector<VectorXd>;

constexpr double kTurn = 2 * M_PI;

GraspCandidate candidate(const VectorXd& start, const VectorXd& goal, double cost = 0) {
  GraspCandidate out;
  out.cost = cost;
  out.starts = {start};
  out.goals = {goal};
  return out;
}

VectorXd whole_turns_between(const VectorXd& from, const VectorXd& to) {
  return ((to - from) / kTurn).array().round() * kTurn;
}

/// Some shift by whole turns takes the path between two of the ends, within limits.
bool is_kept(const JointGroup& group, const GraspCandidate& ends, const Path& path) {
  for (const VectorXd& start : ends.starts) {
    const VectorXd shift = whole_turns_between(path.front(), start);
    if ((path.front() + shift - start).norm() > 1e-9) continue;
    const bool inside =
        std::all_of(path.begin(), path.end(), [&](const VectorXd& q) { return group.within_limits(q + shift, 1e-9); });
    const VectorXd end = path.back() + shift;
    if (inside && std::any_of(ends.goals.begin(), ends.goals.end(),
                              [&](const VectorXd& goal) { return (goal - end).norm() < 1e-9; }))
      return true;
  }
  return false;
}

double length_of(const Path& path) {
  double sum = 0;
  for (std::size_t i = 1; i < path.size(); ++i) sum += (path[i] - path[i - 1]).norm();
  return sum;
}

TEST(TurnedEnds, EveryCheaperPathRunsBetweenSomeOfThem) {
  Rng rng(11);
  int kept = 0, cut_off = 0;
  std::size_t ends = 0, all = 0;
  const std::vector<std::pair<double, double>> kinds{{-kTurn, kTurn}, {-3.5, 3.5}, {-2, 2}, {-9, 5}, {-4.71, 4.71}};
  for (int trial = 0; trial < 400; ++trial) {
    std::vector<std::pair<double, double>> limits;
    for (int i = 0; i < 3; ++i) limits.push_back(kinds[rng.index(kinds.size())]);
    const JointGroup group = test::limited_arm(limits);
    const WholeTurns turns(group);
    const VectorXd start = rng.uniform(group.lower(), group.upper()), goal = rng.uniform(group.lower(), group.upper());
    const VectorXd middle = 0.5 * (group.lower() + group.upper());
    // As inverse kinematics gives them.
    const double cost = rng.uniform(0.0, 1.0), bound = rng.uniform(2.0, 8.0);
    GraspCandidate turned = candidate(turns.of(start, middle, 1).front(), turns.of(goal, middle, 1).front(), cost);
    const GraspCandidate before = turned;
    add_turned_ends(turns, group, bound, turned);
    const std::vector<VectorXd> starts = turns.of(start, middle), goals = turns.of(goal, middle);
    ends += turned.starts.size() * turned.goals.size();
    all += starts.size() * goals.size();
    for (const VectorXd& q : turned.starts) EXPECT_TRUE(group.within_limits(q));
    for (const VectorXd& q : turned.goals) EXPECT_TRUE(group.within_limits(q));
    for (int i = 0; i < 200; ++i) {
      // Through a random place, between random turns.
      const VectorXd a = starts[rng.index(starts.size())], b = goals[rng.index(goals.size())];
      const VectorXd reach = VectorXd::Constant(3, 3);
      VectorXd through = 0.5 * (a + b) + rng.uniform(-reach, reach);
      through = through.cwiseMax(group.lower()).cwiseMin(group.upper());
      const Path path{a, through, b};
      if (length_of(path) + cost >= bound) continue;
      EXPECT_TRUE(is_kept(group, turned, path));
      ++kept;
      cut_off += !is_kept(group, before, path);
    }
  }
  EXPECT_GT(kept, 2000);
  EXPECT_GT(cut_off, 500);   // Without the turns.
  EXPECT_LT(4 * ends, all);  // Far fewer than all pairs.
}

TEST(TurnedEnds, TheNearestPairOfAllIsAmongThem) {
  Rng rng(12);
  for (const double bound : {std::numeric_limits<double>::infinity(), 30.0})
    for (int trial = 0; trial < 200; ++trial) {
      std::vector<std::pair<double, double>> limits;
      for (int i = 0; i < 6; ++i) limits.emplace_back(rng.uniform(-7.0, -2.0), rng.uniform(2.0, 7.0));
      const JointGroup group = test::limited_arm(limits);
      const WholeTurns turns(group);
      const VectorXd middle = 0.5 * (group.lower() + group.upper());
      const VectorXd start = rng.uniform(group.lower(), group.upper()),
                     goal = rng.uniform(group.lower(), group.upper());
      GraspCandidate turned = candidate(turns.of(start, middle, 1).front(), turns.of(goal, middle, 1).front());
      add_turned_ends(turns, group, bound, turned);
      double least = std::numeric_limits<double>::infinity();
      for (const VectorXd& a : turns.of(start, middle))
        for (const VectorXd& b : turns.of(goal, middle)) least = std::min(least, (b - a).norm());
      EXPECT_NEAR(turned.straight_cost(), least, 1e-9);
    }
}

/// Limits of +-3.5: the nearest turn of the goal is beyond them, that of the start is not.
TEST(TurnedEnds, LimitsCutATurnOff) {
  const JointGroup group = test::limited_arm({{-3.5, 3.5}, {-2, 2}});
  GraspCandidate turned = candidate(Eigen::Vector2d(3.0, 0), Eigen::Vector2d(-2.7, 0.2));
  add_turned_ends(WholeTurns(group), group, std::numeric_limits<double>::infinity(), turned);
  ASSERT_EQ(turned.starts.size(), 2u);
  ASSERT_EQ(turned.goals.size(), 1u);
  EXPECT_NEAR(turned.starts.front()[0], 3.0 - kTurn, 1e-12);  // The nearer one first.
  EXPECT_NEAR(turned.straight_cost(), std::hypot(kTurn - 5.7, 0.2), 1e-12);
}

/// Two turns on each of six joints: a good path leaves a handful of ends.
TEST(TurnedEnds, AFewDoForAUniversalRobot) {
  const JointGroup group = test::limited_arm(std::vector<std::pair<double, double>>(6, {-kTurn, kTurn}));
  Rng rng(3);
  const VectorXd half = VectorXd::Constant(6, M_PI);
  double starts = 0, goals = 0;
  for (int trial = 0; trial < 100; ++trial) {
    GraspCandidate turned = candidate(rng.uniform(-half, half), rng.uniform(-half, half));
    const WholeTurns turns(group);
    double least = 0;
    for (int i = 0; i < 6; ++i)
      least += std::pow(std::remainder(turned.goals.front()[i] - turned.starts.front()[i], kTurn), 2);
    add_turned_ends(turns, group, 1.2 * std::sqrt(least), turned);
    starts += static_cast<double>(turned.starts.size()) / 100;
    goals += static_cast<double>(turned.goals.size()) / 100;
  }
  RecordProperty("starts", std::to_string(starts));
  RecordProperty("goals", std::to_string(goals));
  EXPECT_LT(starts, 12);
  EXPECT_LT(goals, 12);
}

}  // namespace
}  // namespace mmgrasp::detail
