#include "mmgrasp/grasp/push_grasp.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "mmgrasp/core/error.hpp"
#include "mmgrasp/core/random.hpp"
#include "mmgrasp/grasp/hand.hpp"

namespace mmgrasp {
namespace {

/// The same process walked through in small steps of time: the reference that knows no formula.
struct Walked {
  bool passes = false;  ///< The tips went past without touching, the clearance kept.
  double depth = 0;     ///< Engagement when both fingers touch.
  double pushed = 0;
  bool holds(const PushGraspProblem& p) const { return passes && depth >= p.grip_depth && pushed <= p.max_push; }
};

Walked walk(const PushGraspProblem& p, double start, double farther, double aside) {
  Walked out;
  const double h = 2e-6;
  double tool = std::min(start, -1e-3) - 1e-3 - p.tool_speed * 1e-3 + std::min(farther, 0.0);  // of the tips; face at 0
  double object = farther, opening = p.opening;
  bool reached = false;
  while (opening > p.object_width) {
    tool += h * p.tool_speed;
    if (tool >= start) opening -= h * p.closing_speed;
    if (!reached && tool >= object) {
      reached = true;
      out.passes = opening / 2 >= p.object_width / 2 + std::abs(aside) + p.clearance;
    }
    if (tool - object > p.finger_length) object = tool - p.finger_length;
  }
  if (!reached) return out;
  out.depth = tool - object;
  out.pushed = object - farther;
  return out;
}

PushGraspProblem random_problem(Rng& rng) {
  PushGraspProblem p;
  p.object_width = rng.uniform(0.02, 0.07);
  p.opening = p.object_width + rng.uniform(0.01, 0.06);
  p.closing_speed = rng.uniform(0.05, 0.3);
  p.tool_speed = rng.uniform(0.05, 0.6);
  p.finger_length = rng.uniform(0.04, 0.15);
  p.grip_depth = rng.uniform(0.1, 0.4) * p.finger_length;
  p.planned_depth = rng.uniform(0.5, 0.9) * p.finger_length;
  p.clearance = rng.uniform(0.0, 0.003);
  p.max_push = rng.uniform(0.0, 0.15);
  p.along_error = rng.uniform(0.0, 0.01);
  p.lateral_error = rng.uniform(0.0, 0.01);
  return p;
}

TEST(PushGrasp, OutcomesAreThoseOfWalkingThroughTime) {
  Rng rng(3);
  int held = 0, pushed = 0;
  for (int i = 0; i < 60; ++i) {
    const PushGraspProblem p = random_problem(rng);
    const double start = rng.uniform(-0.05, 0.05);
    const ClosingOutcome out = closing_outcome(p, start);
    const Walked walked = walk(p, start, 0, 0);
    held += out.holds;
    pushed += out.pushed > 0;
    if (out.both_touch > 0.001) {
      EXPECT_NEAR(walked.depth, std::min(out.both_touch, p.finger_length), 1e-5);
    }
    EXPECT_NEAR(walked.pushed, out.pushed, 1e-5);
    if (std::abs(out.lateral_tolerance) > 1e-4 && std::abs(out.both_touch - p.grip_depth) > 1e-4 &&
        std::abs(out.pushed - p.max_push) > 1e-4) {
      EXPECT_EQ(walked.holds(p), out.holds) << i;
    }
  }
  EXPECT_GT(held, 10);
  EXPECT_GT(pushed, 10);
}

TEST(PushGrasp, TolerancesAreWhereWalkingBeginsToFail) {
  Rng rng(5);
  int checked = 0;
  const double e = 2e-5;
  for (int i = 0; i < 60; ++i) {
    PushGraspProblem p = random_problem(rng);
    p.along_error = p.lateral_error = 0;
    const PushGrasp found = push_grasp(p);
    if (!found.feasible || !found.push.holds) continue;
    const ClosingOutcome& out = found.push;
    if (std::min(out.nearer_tolerance, out.farther_tolerance) < 2 * e) continue;  // on the window's very edge
    ++checked;
    EXPECT_TRUE(walk(p, out.start, 0, out.lateral_tolerance - e).holds(p)) << i;
    EXPECT_FALSE(walk(p, out.start, 0, out.lateral_tolerance + e).holds(p)) << i;
    EXPECT_TRUE(walk(p, out.start, out.farther_tolerance - e, 0).holds(p)) << i;
    EXPECT_FALSE(walk(p, out.start, out.farther_tolerance + e, 0).holds(p)) << i;
    EXPECT_TRUE(walk(p, out.start, -(out.nearer_tolerance - e), 0).holds(p)) << i;
    EXPECT_FALSE(walk(p, out.start, -(out.nearer_tolerance + e), 0).holds(p)) << i;
  }
  EXPECT_GT(checked, 20);
}

TEST(PushGrasp, TheWindowIsWhereEveryErrorIsHeld) {
  Rng rng(7);
  int feasible = 0;
  for (int i = 0; i < 40; ++i) {
    const PushGraspProblem p = random_problem(rng);
    const PushGrasp found = push_grasp(p);
    const auto all_held = [&p](double start) {
      for (const double x : {-p.along_error, p.along_error})
        if (!walk(p, start, x, p.lateral_error).holds(p)) return false;
      return true;
    };
    const double e = 3e-5;
    if (found.feasible) {
      ++feasible;
      EXPECT_NEAR(found.window, (found.latest - found.earliest) / p.tool_speed, 1e-15);
      EXPECT_FALSE(all_held(found.earliest - e)) << i;
      EXPECT_FALSE(all_held(found.latest + e)) << i;
      if (found.latest - found.earliest > 2 * e) {
        EXPECT_TRUE(all_held(found.earliest + e)) << i;
        EXPECT_TRUE(all_held(found.latest - e)) << i;
        EXPECT_TRUE(all_held(std::clamp(found.push.start, found.earliest + e, found.latest - e))) << i;
      }
    } else {
      for (double start = -0.2; start < 0.2; start += 0.01) EXPECT_FALSE(all_held(start)) << i;
    }
  }
  EXPECT_GT(feasible, 10);
  EXPECT_LT(feasible, 40);
}

TEST(PushGrasp, TheSpeedLimitIsWhereTheWindowCloses) {
  Rng rng(11);
  int limited = 0;
  for (int i = 0; i < 200; ++i) {
    PushGraspProblem p = random_problem(rng);
    const double limit = push_grasp(p).max_tool_speed;
    if (limit == 0) {
      EXPECT_FALSE(push_grasp(p).feasible);
      continue;
    }
    ++limited;
    p.tool_speed = limit * (1 - 1e-9);
    EXPECT_TRUE(push_grasp(p).feasible);
    p.tool_speed = limit * (1 + 1e-9);
    EXPECT_FALSE(push_grasp(p).feasible);
  }
  EXPECT_GT(limited, 50);
  PushGraspProblem exact;
  exact.tool_speed = 50;
  EXPECT_TRUE(std::isinf(push_grasp(exact).max_tool_speed));
  EXPECT_TRUE(push_grasp(exact).feasible);
}

// Figure 4.7: P1's gripper closes 0.1 m/s. At 0.5 m/s and 6 cm deep, plain closing leaves c e / (2 v) = 6 mm a side,
// the open hand 25 mm.
TEST(PushGrasp, FigureFourSevenInNumbers) {
  PushGraspProblem p;
  p.tool_speed = 0.5;
  p.max_push = 0.3;
  const PushGrasp found = push_grasp(p);
  EXPECT_NEAR(found.closing_time, 0.5, 1e-12);
  EXPECT_NEAR(found.plain.side_clearance, 0.1 * 0.06 / (2 * 0.5), 1e-12);
  EXPECT_NEAR(found.plain.both_touch, 0.06, 1e-12);
  EXPECT_EQ(found.plain.pushed, 0);
  EXPECT_NEAR(found.push.side_clearance, 0.025, 1e-12);
  EXPECT_GE(found.push.start, 0);
  EXPECT_NEAR(found.push.both_touch, found.push.start + 0.25, 1e-12);
  EXPECT_NEAR(found.push.pushed, found.push.both_touch - 0.12, 1e-12);
  EXPECT_NEAR(found.push.swept, found.push.both_touch - 0.06, 1e-12);
}

TEST(PushGrasp, AHitObjectLeapsAsFarAsItsFriction) {
  // Walked: object leaves at (1 + r) v, slowed by mu g; its lead over the palm at v.
  const double length = 0.03, mu = 0.3, r = 0.4, v = push_speed_limit(length, mu, r);
  double lead = 0, most = 0, u = (1 + r) * v;
  for (const double h = 1e-6; u > v;) {
    u -= h * mu * 9.81;
    lead += h * (u - v);
    most = std::max(most, lead);
  }
  EXPECT_NEAR(most, length, 1e-5);
  EXPECT_TRUE(std::isinf(push_speed_limit(length, mu, 0)));
}

TEST(PushGrasp, TakesItsLengthsFromTheHand) {
  Hand hand;
  hand.max_opening = 0.09;
  hand.clearance = 0.004;
  hand.finger_depth = 0.05;
  hand.body.finger_length = 0.08;
  const PushGraspProblem p = push_grasp_problem(hand, 0.06);
  EXPECT_DOUBLE_EQ(p.opening, 0.09);
  EXPECT_DOUBLE_EQ(p.object_width, 0.06);
  EXPECT_DOUBLE_EQ(p.finger_length, 0.08);
  EXPECT_DOUBLE_EQ(p.grip_depth, 0.025);
  EXPECT_DOUBLE_EQ(p.planned_depth, 0.04);
  EXPECT_DOUBLE_EQ(p.clearance, 0.004);
  EXPECT_DOUBLE_EQ(push_grasp(p).closing_time, 0.03 / p.closing_speed);
  hand.body.finger_length = 0.03;  // shorter than its pads
  EXPECT_NO_THROW(push_grasp_problem(hand, 0.06).check());
  EXPECT_THROW(push_grasp_problem(hand, 0.09), InvalidInput);
}

TEST(PushGrasp, BadInputIsRefusedByName) {
  const auto refused = [](double PushGraspProblem::*member, double value, const std::string& field) {
    PushGraspProblem p;
    p.*member = value;
    try {
      push_grasp(p);
      ADD_FAILURE() << field << " accepted";
    } catch (const InvalidInput& error) {
      EXPECT_NE(std::string(error.what()).find(field), std::string::npos) << error.what();
    }
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {0.0, -1.0, nan, double(INFINITY)}) {
    refused(&PushGraspProblem::closing_speed, bad, "closing_speed");
    refused(&PushGraspProblem::tool_speed, bad, "tool_speed");
    refused(&PushGraspProblem::finger_length, bad, "finger_length");
    refused(&PushGraspProblem::object_width, bad, "object_width");
  }
  for (const double bad : {-1e-3, nan, double(INFINITY)}) {
    refused(&PushGraspProblem::clearance, bad, "clearance");
    refused(&PushGraspProblem::max_push, bad, "max_push");
    refused(&PushGraspProblem::along_error, bad, "along_error");
    refused(&PushGraspProblem::lateral_error, bad, "lateral_error");
    refused(&PushGraspProblem::along_deviation, bad, "along_deviation");
    refused(&PushGraspProblem::lateral_deviation, bad, "lateral_deviation");
    refused(&PushGraspProblem::sigmas, bad, "sigmas");
  }
  refused(&PushGraspProblem::opening, 0.05, "opening");
  refused(&PushGraspProblem::grip_depth, 0.2, "grip_depth");
  refused(&PushGraspProblem::planned_depth, 0.01, "planned_depth");
  EXPECT_THROW(closing_outcome({}, nan), InvalidInput);
  EXPECT_THROW(push_speed_limit(0, 0.3, 0.5), InvalidInput);
  EXPECT_THROW(push_speed_limit(0.1, 0.3, 1.5), InvalidInput);
}

TEST(PushGrasp, CoversStandardDeviationsAndSaysHowProbableItIsToHold) {
  Rng rng(21);
  int covered = 0;
  for (int trial = 0; trial < 12; ++trial) {
    PushGraspProblem p = random_problem(rng);
    p.along_error = p.lateral_error = 0;
    p.along_deviation = rng.uniform(0.002, 0.02);
    p.lateral_deviation = rng.uniform(0.001, 0.01);
    const PushGrasp grasp = push_grasp(p);
    if (grasp.feasible) {
      ++covered;
      EXPECT_GE(grasp.push.covered_sigmas, p.sigmas - 1e-9);
    }
    const ClosingOutcome& push = grasp.push;
    // The box of so many deviations is held up to its corners, and a hair more is not.
    const auto held = [&](double k) {
      bool all = true;
      for (const double x : {-1, 0, 1})
        for (const double y : {0, 1})
          all = all && walk(p, push.start, x * k * p.along_deviation, y * k * p.lateral_deviation).holds(p);
      return all;
    };
    if (push.covered_sigmas > 0.05) {
      EXPECT_TRUE(held(0.98 * push.covered_sigmas));
      EXPECT_FALSE(held(1.02 * push.covered_sigmas));
    }
    const int draws = 400;
    int count = 0;
    for (int i = 0; i < draws; ++i)
      count += walk(p, push.start, p.along_deviation * rng.normal(), p.lateral_deviation * rng.normal()).holds(p);
    const double off = 4.5 * std::sqrt(push.probability * (1 - push.probability) / draws) + 0.01;
    EXPECT_NEAR(push.probability, static_cast<double>(count) / draws, off);
  }
  EXPECT_GE(covered, 2);
  PushGraspProblem sure;
  EXPECT_EQ(push_grasp(sure).push.covered_sigmas, std::numeric_limits<double>::infinity());
  EXPECT_EQ(push_grasp(sure).push.probability, 1);
  sure.lateral_deviation = 1;
  EXPECT_FALSE(push_grasp(sure).feasible);
  EXPECT_LT(push_grasp(sure).push.probability, 0.05);
}

}  // namespace
}  // namespace mmgrasp
